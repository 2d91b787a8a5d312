// SPDX-License-Identifier: Apache-2.0
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands/verbs.h"
#include "app/result_directory.h"
#include "app/result_picture.h"
#include "app/targets/target_result.h"
#include "io/image_files.h"
#include "io/video_writer.h"
#include "view/renderer.h"
#include "view/report.h"

namespace alidade {
namespace {

struct ViewOptions {
  double azimuth_deg = 35.0;
  double elevation_deg = 28.0;
  double distance = 1.0;
  int width = 1500, height = 1000;  // px
  double point_size_px = 0.0;       // by their number
  bool turntable = false;
  double turn_s = 8.0;
};

// A result as it is to be drawn.
struct SeenResult {
  Scene scene;
  std::vector<std::string> warnings;
  nlohmann::json summary;
};

SeenResult see_targets(const std::filesystem::path& path, const std::filesystem::path& truth) {
  return {read_target_scene(path, truth), {}, {{"result", path.string()}}};
}

SeenResult see_track(const std::filesystem::path& path, const std::filesystem::path& truth) {
  const ResultPicture result = read_result_picture(path, truth);
  return {track_scene(result.picture),
          result.warnings,
          {{"result", path.string()},
           {"points", result.picture.map.points.size()},
           {"poses", result.picture.estimate.size()},
           {"true_poses", result.picture.truth ? result.picture.truth->size() : 0},
           {"warnings", result.warnings}}};
}

class ViewCommand : public Command {
 public:
  explicit ViewCommand(CLI::App& flags) {
    flags.add_option("RESULT", result_, "result directory, or a trajectory file")->required();
    flags.add_option("--truth", truth_,
                     "trajectory, or true paths of targets, to draw beside it (default: RESULT/truth.tum, truth.csv)");
    options_.add("azimuth_deg", view_.azimuth_deg, "deg",
                 "where to look from: 0 from behind the cameras, 90 from their right");
    options_.add("elevation_deg", view_.elevation_deg, "deg", "above the horizon of the cameras");
    options_.add("distance", view_.distance, "", "as a multiple of the distance that fits all into the picture");
    options_.add("width", view_.width, "px", "of the picture");
    options_.add("height", view_.height, "px", "of the picture");
    options_.add("point_size_px", view_.point_size_px, "px", "of a map point; 0: by their number");
    options_.add("turntable", view_.turntable, "", "also a movie of one turn round the scene, turntable.mp4");
    options_.add("turn_s", view_.turn_s, "s", "time of the turn");
    options_.add_check([this] { check(); });
  }

  ExitCode run(const RunContext& context) override {
    SeenResult seen = is_target_result(result_) ? see_targets(result_, truth_) : see_track(result_, truth_);
    for (const std::string& warning : seen.warnings) context.warn(warning);
    Scene& scene = seen.scene;
    if (view_.point_size_px > 0) scene.point_size_px = view_.point_size_px;
    Renderer renderer;
    renderer.show(scene);
    const Viewpoint viewpoint = frame_scene(scene, angles(), static_cast<double>(view_.width) / view_.height);
    const cv::Mat picture = renderer.render(viewpoint, size());

    ResultDirectory directory(context.output, "view");
    write_image(directory.path("scene.png"), picture);
    const bool complete = !view_.turntable || write_turntable(context, renderer, viewpoint, directory);
    directory.write_text("options.yaml", options_.to_yaml());
    Report report;
    report.title = "View of " + result_.string();
    report.arguments = context.arguments;
    report.warnings = seen.warnings;
    report.options = options_.to_yaml();
    report.sections = {{"", {}, {}, {{picture, "", FigureFormat::Png}}}};
    if (view_.turntable && complete) report.links = {{"turntable.mp4", "one turn round the scene"}};
    write_report(directory.path("report.html"), report);
    directory.commit(seen.summary);
    context.publish(seen.summary);
    context.tell(fmt::format("picture: {}", directory.final_path("scene.png").string()));
    return complete ? ExitCode::Success : ExitCode::Interrupted;
  }

 private:
  void check() const {
    const auto require = [](bool good, const char* field, double value, const char* bound) {
      if (!good) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
    };
    require(view_.distance > 0 && view_.distance <= 1e3, "distance", view_.distance, "> 0 and <= 1000");
    require(view_.elevation_deg >= -90 && view_.elevation_deg <= 90, "elevation_deg", view_.elevation_deg,
            "-90..90 deg");
    require(view_.width >= 64 && view_.width <= 4096, "width", view_.width, "64..4096 px");
    require(view_.height >= 64 && view_.height <= 4096, "height", view_.height, "64..4096 px");
    require(view_.point_size_px >= 0 && view_.point_size_px <= 50, "point_size_px", view_.point_size_px, "0..50 px");
    require(view_.turn_s > 0 && view_.turn_s <= 600, "turn_s", view_.turn_s, "> 0 and <= 600 s");
  }

  cv::Size size() const { return {view_.width, view_.height}; }

  ViewAngles angles() const {
    constexpr double kRadians = std::numbers::pi / 180.0;
    return {view_.azimuth_deg * kRadians, view_.elevation_deg * kRadians, view_.distance};
  }

  // False where the user stopped it; an unfinished movie removes itself.
  bool write_turntable(const RunContext& context, Renderer& renderer, const Viewpoint& start,
                       const ResultDirectory& directory) const {
    VideoOptions options;
    options.fps_hz = 25.0;
    VideoWriter movie(directory.path("turntable.mp4"), size(), options);
    const int count = std::max(1, static_cast<int>(view_.turn_s * options.fps_hz));
    for (int i = 0; i < count; ++i) {
      if (context.stop.stop_requested()) return false;
      movie.write(renderer.render(turned(start, 2.0 * std::numbers::pi * i / count), size()));
      context.progress({"turntable", i + 1, count, ""});
    }
    movie.close();
    return true;
  }

  std::filesystem::path result_, truth_;
  ViewOptions view_;
};

}  // namespace

Verb view_verb() {
  return {"view", "draws a result again, from elsewhere or as a movie",
          "alidade view track --azimuth-deg 90 --elevation-deg 60 --turntable -o pictures", OutputUse::Required,
          make_command<ViewCommand>};
}

}  // namespace alidade
