// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/board_simulation.h"
#include "app/commands/verbs.h"
#include "app/result_directory.h"
#include "app/sequence_writer.h"
#include "calib/boards/board_text.h"
#include "io/camera_file.h"

namespace alidade {
namespace {

class SimulateBoardCommand : public Command {
 public:
  explicit SimulateBoardCommand(CLI::App& flags) {
    flags.add_option("--camera", camera_file_, "camera file, instead of 640x480 px with a barrel-shaped lens");
    options_.add("board", board_, "",
                 "such as chessboard:9x6:25mm, charuco:8x6:30mm:22mm:5X5_100, aprilgrid:6x6:24mm:6mm");
    options_.add("images", simulation_.images, "", "number of images");
    options_.add("tilt_deg", simulation_.poses.most_tilt_deg, "deg", "largest tilt of the board");
    options_.add("least_fill", simulation_.poses.least_fill, "", "share of the image that the board takes, farthest");
    options_.add("most_fill", simulation_.poses.most_fill, "", "the same, nearest");
    options_.add("partial", simulation_.poses.partial, "", "boards may lie partly outside the image");
    options_.add("blur_px", simulation_.rendering.blur_px, "px", "standard deviation of the lens' blur");
    options_.add("noise_grey", simulation_.rendering.noise_grey, "grey levels",
                 "standard deviation of the pixel noise");
    options_.add("supersampling", simulation_.rendering.supersampling, "", "rays per side of a pixel");
    options_.add("bulge_x_mm", simulation_.bulge_mm.x(), "mm", "height of the middle over the left and right rim");
    options_.add("bulge_y_mm", simulation_.bulge_mm.y(), "mm", "height of the middle over the upper and lower rim");
    options_.add_check([this] { validate(simulation_); });
  }

  ExitCode run(const RunContext& context) override {
    simulation_.board = parse_board(board_);
    if (!camera_file_.empty()) simulation_.camera = read_camera(camera_file_);
    simulation_.seed = context.seed;
    const BoardSimulation simulation(simulation_);
    ResultDirectory directory(context.output, "simulate board");
    SequenceWriter writer(directory, simulation_.camera, SequenceForm::Images, 1.0);
    std::vector<cv::Mat> shown;
    for (int i = 0; i < simulation.count() && !context.stop.stop_requested(); ++i) {
      const cv::Mat image = simulation.image(i);
      writer.add(image, {Timestamp(std::chrono::seconds(i)), simulation.T_board_camera(i), std::nullopt}, std::nullopt);
      if (i < kShown) shown.push_back(image);
      context.progress({"rendering", i + 1, simulation.count(), ""});
    }
    writer.finish();
    const int written = static_cast<int>(writer.truth().size());
    directory.write_text("options.yaml", options_.to_yaml());
    Report report = report_of(simulation_, shown, written);
    report.arguments = context.arguments;
    report.options = options_.to_yaml();
    write_report(directory.path("report.html"), report);
    const nlohmann::json summary = summary_of(simulation_, written);
    directory.commit(summary);
    context.publish(summary);
    context.tell(
        fmt::format("{} images of a {} written to {}", written, describe(simulation_.board), context.output.string()));
    return written < simulation.count() ? ExitCode::Interrupted : ExitCode::Success;
  }

 private:
  static constexpr int kShown = 6;

  static BoardSimulationOptions usual() {
    BoardSimulationOptions options;
    options.camera = {640, 480, 520, 520, 319.5, 239.5, BrownConrady{-0.25, 0.08, 0.001, -0.0005}};
    options.rendering.blur_px = 0.5;
    options.rendering.noise_grey = 2;
    return options;
  }

  std::filesystem::path camera_file_;
  std::string board_ = "charuco:8x6:30mm:22mm:5X5_100";
  BoardSimulationOptions simulation_ = usual();
};

}  // namespace

Verb simulate_board_verb() {
  return {"simulate board", "images of a calibration board through a known lens, with exact truth",
          "alidade simulate board --board chessboard:9x6:25mm --images 30 -o boards", OutputUse::Required,
          make_command<SimulateBoardCommand>};
}

}  // namespace alidade
