// SPDX-License-Identifier: Apache-2.0
#include <chrono>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/camera_source.h"
#include "app/commands/verbs.h"
#include "app/frame_overlay.h"
#include "app/live_messages.h"
#include "app/live_output.h"
#include "app/track_record.h"
#include "app/tracker_options.h"
#include "app/world_scale.h"
#include "io/map_file.h"
#include "io/trajectory_file.h"
#include "tracking/camera_tracker.h"
#include "tracking/track_smoothing.h"

namespace alidade {
namespace {

enum class Refine { None, Local, Global };

class TrackCameraCommand : public Command {
 public:
  explicit TrackCameraCommand(CLI::App& flags) {
    flags.add_option("SOURCE", source_, "video, folder or glob of images, or data set folder")->required();
    flags.add_option("--camera", camera_file_,
                     "intrinsics: our YAML, OpenCV, ROS, Kalibr, COLMAP, mrcal, or the data set's file");
    flags.add_option("--map", map_file_, "track in this map (map.ply, or a result directory) instead of making one");
    flags.add_option("--init-poses", init_poses_, "trajectory with the poses of the first two frames");
    flags.add_option("--scale", scale_, "marker:SIDE_M[:ID] or distance:FRAME_A:FRAME_B:METRES");
    flags.add_option("--fps", fps_hz_, "frames per second of images that have no times")->check(CLI::PositiveNumber);
    flags.add_option("--stream", stream_, kStreamHelp);
    options_.add_choice("refine", refine_,
                        {{"none", Refine::None}, {"local", Refine::Local}, {"global", Refine::Global}},
                        "bundle adjustment: none, of the last keyframes, or also of all in the end");
    options_.add("lag", lag_, "frames",
                 "in a known map: frames after it that a pose goes by as well; -1: all of the recording");
    options_.add("overlay", overlay_, "", "write overlay.mp4: the frames with what was found in them");
    tracker_.sift.most = 0;
    bind(options_, tracker_);
    options_.add_check([this] {
      if (lag_ < -1) throw std::invalid_argument(fmt::format("lag must be >= -1, got {}", lag_));
    });
    options_.add_check([this] { validate(effective_options({640, 480, 500, 500, 320, 240, {}})); });
  }

  ExitCode run(const RunContext& context) override {
    const ScaleWish wish = parse_scale(scale_);
    const Trajectory given = init_poses_.empty() ? Trajectory{} : read_trajectory(init_poses_).poses;
    std::optional<PointMap> known_map;
    if (!map_file_.empty()) known_map = read_map();
    CameraSource source = open_camera_source(source_, camera_file_, fps_hz_);
    CameraTracker tracker(source.camera, effective_options(source.camera), std::move(known_map), given);
    std::optional<LiveOutput> live;
    if (!stream_.empty()) live.emplace(context, stream_, hello_message(hello(source, tracker)));
    ResultDirectory directory(context.output, "track camera");

    TrackRecord record;
    record.camera = source.camera;
    record.source = source.frames->describe();
    record.has_times = source.frames->has_times();
    follow(context, source, tracker, directory, live ? &*live : nullptr, record);
    if (live) live->end(end_message(live_end(tracker, record)));
    if (const auto fault = source.frames->fault()) record.warnings.push_back(*fault);
    finish(context, tracker, given, wish, record);
    for (const std::string& warning : record.warnings) context.warn(warning);
    write_track(record, directory, context.arguments, options_.to_yaml());
    for (const std::string& line : table_lines(record)) tell(context, line);
    const nlohmann::json summary = summary_of(record);
    directory.commit(summary);
    context.publish(summary);
    tell(context, fmt::format("written to {}", context.output.string()));
    if (record.interrupted) return ExitCode::Interrupted;
    return answer(context, record);
  }

 private:
  CameraTrackerOptions effective_options(const Camera& camera) const {
    CameraTrackerOptions options = tracker_;
    options.local_refinement = refine_ != Refine::None;
    if (options.sift.most == 0) options.sift.most = suggested_feature_count(camera);
    return options;
  }

  PointMap read_map() const {
    const std::filesystem::path path(map_file_);
    return read_map_ply(std::filesystem::is_directory(path) ? path / "map.ply" : path);
  }

  void follow(const RunContext& context, CameraSource& source, CameraTracker& tracker, const ResultDirectory& directory,
              LiveOutput* live, TrackRecord& record) {
    using Clock = std::chrono::steady_clock;
    const auto total = source.frames->frame_count();
    OverlayMovie movie(directory.path("overlay.mp4"), record.has_times ? fps_hz_.value_or(30.0) : 5.0, total);
    const bool look_for_markers = scale_.starts_with("marker");
    std::string told;
    for (;;) {
      if (context.stop.stop_requested()) {
        record.interrupted = true;
        break;
      }
      const auto begin = Clock::now();
      const auto frame = next_image(source);
      if (!frame) break;
      const FrameReport report = tracker.step(*frame);
      tracked_at_once_ += report.state == FrameState::Tracked;
      if (live) live->send(pose_message(source_, report, source.stamp));
      record.tracking_s += std::chrono::duration<double>(Clock::now() - begin).count();
      if (look_for_markers && report.is_keyframe) markers_.push_back({report.index, detect_markers(frame->grey)});
      if (overlay_) movie.add(*frame, report);
      Progress progress{"tracking", frame->index + 1, total.value_or(0), ""};
      const std::string news =
          report.reason.empty() ? "" : fmt::format("{}: {}", to_string(report.state), report.reason);
      if (news != told) progress.message = told = news;
      context.progress(progress);
    }
    record.overlays = movie.close();
  }

  void finish(const RunContext& context, const CameraTracker& tracker, const Trajectory& given, const ScaleWish& wish,
              TrackRecord& record) const {
    record.reports = tracker.reports();
    LiveMap live = tracker.live_map();
    if (refine_ == Refine::Global && !record.interrupted && live.map.keyframes.size() >= 2) {
      RefinedTrack refined =
          refine_globally(record.camera, std::move(live), std::move(record.reports), tracker.options(),
                          tracker.anchored_keyframes(), context.progress, context.stop);
      record.interrupted = context.stop.stop_requested();
      live = std::move(refined.live);
      record.reports = std::move(refined.reports);
      record.refinement = refined.summary;
      if (const auto warning = doubt_focal_length(record.camera, refined.summary)) record.warnings.push_back(*warning);
    }
    // A map that is made on the way brings its poses along, by bundle adjustment.
    const bool filtered = tracker.localises_only() && record.has_times && tracker.options().pose == PoseMethod::Ekf;
    if (filtered && lag_ != 0) {
      record.reports = smoothed(std::move(record.reports), {lag_});
    }
    record.map = without_unseen_points(std::move(live.map));
    if (tracker.localises_only()) record.scale = "of the map";
    if (tracker.anchored_keyframes() == 2) {
      record.scale = "from the given poses";
    } else if (const auto similarity = similarity_to_given_poses(record.reports, given)) {
      move_into(*similarity, "from the given poses", record);
    }
    if (wish.index() != 0) {
      if (const auto found = find_scale(wish, record.camera, record.reports, markers_)) {
        move_into(found->T_metric_map, found->words, record);
      } else {
        record.warnings.push_back("--scale " + scale_ + " was not found in the images: the unit of length stays free");
      }
    }
  }

  static void move_into(const Similarity& similarity, const std::string& words, TrackRecord& record) {
    record.map = transform(similarity, std::move(record.map));
    record.reports = transform(similarity, std::move(record.reports));
    record.scale = words;
  }

  LiveHello hello(const CameraSource& source, const CameraTracker& tracker) const {
    return {"track camera", source_, source.frames->has_times() ? "of the recording" : "none: 1 s per frame",
            "T_world_camera", tracker.localises_only() || !init_poses_.empty()};
  }

  LiveEnd live_end(const CameraTracker& tracker, const TrackRecord& record) const {
    return {static_cast<std::int64_t>(tracker.reports().size()), tracked_at_once_, record.interrupted};
  }

  // Standard output may be for poses alone.
  void tell(const RunContext& context, const std::string& line) const {
    if (leaves_standard_output(stream_)) context.tell(line);
  }

  ExitCode answer(const RunContext& context, const TrackRecord& record) const {
    if (count(record.reports, FrameState::Tracked) > 0) return ExitCode::Success;
    std::string reason = "no image";
    for (const FrameReport& report : record.reports) {
      if (!report.reason.empty()) reason = report.reason;
    }
    context.warn(fmt::format("{}: no frame could be tracked: {}", source_, reason));
    return ExitCode::NoAnswer;
  }

  std::string source_, map_file_, init_poses_, scale_, stream_;
  std::filesystem::path camera_file_;
  std::optional<double> fps_hz_;
  Refine refine_ = Refine::Global;
  int lag_ = -1;
  bool overlay_ = true;
  std::int64_t tracked_at_once_ = 0;
  CameraTrackerOptions tracker_;
  std::vector<FrameMarkers> markers_;
};

}  // namespace

Verb track_camera_verb() {
  return {"track camera", "where a camera was at every frame, and a map of what it saw",
          "alidade track camera video.mp4 --camera camera.yaml -o track", OutputUse::Required,
          make_command<TrackCameraCommand>};
}

}  // namespace alidade
