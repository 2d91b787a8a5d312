// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/camera_source.h"
#include "app/commands/verbs.h"
#include "app/posed_images.h"
#include "app/track_record.h"
#include "io/trajectory_file.h"
#include "tracking/posed_map.h"

namespace alidade {
namespace {

class MapCommand : public Command {
 public:
  explicit MapCommand(CLI::App& flags) {
    flags.add_option("SOURCE", source_, "data set folder with poses, or images or a video with --poses")->required();
    flags.add_option("--camera", camera_file_, "intrinsics; default: the data set's");
    flags.add_option("--poses", poses_file_, "trajectory of the camera; default: the data set's");
    flags.add_option("--fps", fps_hz_, "frames per second of images that have no times")->check(CLI::PositiveNumber);
    map_.sift.most = 0;
    options_.add("sift.most", map_.sift.most, "", "features per image; 0: by the size of the images");
    options_.add("pose_sigma_m", map_.pose_sigma_m, "m", "of the given poses");
    options_.add("pose_sigma_rad", map_.pose_sigma_rad, "rad", "of the given poses");
    options_.add("depth_sigma_at_1m", map_.depth_sigma_at_1m, "m", "of the depth at 1 m; grows with its square");
    options_.add("most_depth_m", map_.most_depth_m, "m", "depth beyond it is not believed");
    options_.add("growth.ratio", map_.growth.ratio, "", "descriptor distance, nearest to second nearest");
  }

  ExitCode run(const RunContext& context) override {
    CameraSource source = open_camera_source(source_, camera_file_, fps_hz_);
    if (map_.sift.most == 0) map_.sift.most = suggested_feature_count(source.camera);
    const Trajectory poses = known_poses(source);
    ResultDirectory directory(context.output, "map");
    TrackRecord record;
    record.camera = source.camera;
    record.source = source.frames->describe();
    record.has_times = source.frames->has_times();
    record.scale = "of the given poses";
    LiveMap live;
    while (const auto frame = next_image(source)) {
      if (context.stop.stop_requested()) {
        record.interrupted = true;
        break;
      }
      context.progress({"mapping", frame->index + 1, source.frames->frame_count().value_or(0), ""});
      const auto image = posed_image(source, *frame, poses);
      if (!image) continue;
      live = with_posed_image(source.camera, std::move(live), *image, map_);
      record.reports.push_back(report_of(*image));
    }
    record.map = std::move(live.map);
    if (record.map.points.empty()) {
      throw InputError(source_, 0, "no point could be mapped: too few images with a known pose overlap",
                       "give more poses with --poses, or images with depth");
    }
    write_track(record, directory, context.arguments, options_.to_yaml());
    directory.commit(summary_of(record));
    context.publish(summary_of(record));
    context.tell(fmt::format("map: {} points from {} images", record.map.points.size(), record.reports.size()));
    context.tell(fmt::format("written to {}", context.output.string()));
    return record.interrupted ? ExitCode::Interrupted : ExitCode::Success;
  }

 private:
  Trajectory known_poses(const CameraSource& source) const {
    if (!poses_file_.empty()) return read_trajectory(poses_file_).poses;
    if (source.dataset && !source.dataset->truth.empty()) return source.dataset->truth;
    throw InputError(source_, 0, "the poses of these images are not known", "give them with --poses");
  }

  static FrameReport report_of(const PosedImage& image) {
    FrameReport report;
    report.index = image.frame.index;
    report.time = image.frame.time;
    report.name = image.frame.name;
    report.state = FrameState::Tracked;
    report.T_world_camera = image.T_world_camera;
    report.is_keyframe = true;
    return report;
  }

  std::string source_, poses_file_;
  std::filesystem::path camera_file_;
  std::optional<double> fps_hz_;
  PosedMapOptions map_;
};

}  // namespace

Verb map_verb() {
  return {"map", "a map to track in, from images whose poses are known",
          "alidade map rgbd_dataset_freiburg1_rpy -o map", OutputUse::Required, make_command<MapCommand>};
}

}  // namespace alidade
