// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/camera_following.h"
#include "app/camera_source.h"
#include "app/capture_warnings.h"
#include "app/commands/verbs.h"
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

enum class Refine { Auto, None, Local, Global };

class TrackCameraCommand : public Command {
 public:
  explicit TrackCameraCommand(CLI::App& flags) {
    flags
        .add_option("SOURCE", source_,
                    "video, folder or glob of images, data set folder, or camera: v4l2:/dev/video0, genicam:ADDRESS")
        ->required();
    flags.add_option("--camera", camera_file_,
                     "intrinsics: our YAML, OpenCV, ROS, Kalibr, COLMAP, mrcal, or the data set's file");
    flags.add_option("--map", map_file_, "track in this map (map.ply, or a result directory) instead of making one");
    flags.add_option("--init-poses", init_poses_, "trajectory with the poses of the first two frames");
    flags.add_option("--scale", scale_, "marker:SIDE_M[:ID] or distance:FRAME_A:FRAME_B:METRES");
    flags.add_option("--fps", fps_hz_, "frames per second of images that have no times")->check(CLI::PositiveNumber);
    flags.add_option("--frames", follow_.most_frames, "stop after so many; a camera goes on until Ctrl-C")
        ->check(CLI::PositiveNumber);
    flags.add_option("--duration", follow_.most_s, "s: stop after that")->check(CLI::PositiveNumber);
    flags.add_option("--stream", stream_, kStreamHelp);
    options_.add_choice(
        "refine", refine_,
        {{"auto", Refine::Auto}, {"none", Refine::None}, {"local", Refine::Local}, {"global", Refine::Global}},
        "bundle adjustment: none, of the last keyframes, or also of all in the end; auto: global, "
        "of a live camera, whose frames have no end, local");
    options_.add("lag", lag_, "frames",
                 "in a known map: frames after it that a pose goes by as well; -1: all of the recording");
    options_.add("overlay", overlay_, "",
                 "write overlay.mp4: the frames with what was found in them; auto: not of a live camera");
    bind(options_, flags, live_.options);
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
    live_.events = warn_of_news(context);
    CameraSource source = open_camera_source(source_, camera_file_, fps_hz_, live_);
    choose_defaults(source.is_live);
    CameraTracker tracker(source.camera, effective_options(source.camera), std::move(known_map), given);
    std::optional<LiveOutput> live;
    if (!stream_.empty()) live.emplace(context, stream_, hello_message(hello(source, tracker)));
    ResultDirectory directory(context.output, "track camera");

    TrackRecord record;
    record.camera = source.camera;
    record.source = source.frames->describe();
    record.has_times = source.frames->has_times();
    const std::optional<DeviceError> fault =
        follow(context, source, tracker, directory, live ? &*live : nullptr, record);
    if (const auto loss = source.frames->fault()) record.warnings.push_back(*loss);
    finish(context, tracker, given, wish, record);
    for (const std::string& warning : record.warnings) context.warn(warning);
    write_track(record, directory, context.arguments, options_.to_yaml());
    for (const std::string& line : table_lines(record)) tell(context, line);
    const nlohmann::json summary = summary_of(record);
    directory.commit(summary);
    context.publish(summary);
    tell(context, fmt::format("written to {}", context.output.string()));
    if (fault) throw *fault;
    if (record.interrupted) return ExitCode::Interrupted;
    return answer(context, record);
  }

 private:
  CameraTrackerOptions effective_options(const Camera& camera) const {
    CameraTrackerOptions options = tracker_;
    options.local_refinement = refine_ != Refine::None;
    constexpr int kMostFollowed = 300;  // of a live camera: in 7 ms per frame
    if (is_endless_) options.most_tracks = std::min(options.most_tracks, kMostFollowed);
    options.will_be_refined = !is_endless_ || refine_ == Refine::Global;
    if (options.sift.most == 0) options.sift.most = suggested_feature_count(camera);
    return options;
  }

  PointMap read_map() const {
    const std::filesystem::path path(map_file_);
    return read_map_ply(std::filesystem::is_directory(path) ? path / "map.ply" : path);
  }

  // What depends on the source and was left to us, before options.yaml tells of it.
  void choose_defaults(bool is_live) {
    is_endless_ = is_live;
    if (refine_ == Refine::Auto) refine_ = is_live ? Refine::Local : Refine::Global;
    overlay_ = overlay_.value_or(!is_live);
  }

  // What ended the source, where it was a device.
  std::optional<DeviceError> follow(const RunContext& context, CameraSource& source, CameraTracker& tracker,
                                    const ResultDirectory& directory, LiveOutput* live, TrackRecord& record) {
    OverlayMovie movie(directory.path("overlay.mp4"), record.has_times ? fps_hz_.value_or(30.0) : 5.0,
                       source.frames->frame_count());
    follow_.source = source_;
    follow_.looks_for_markers = scale_.starts_with("marker");
    follow_.movie = *overlay_ ? &movie : nullptr;
    follow_.live = live;
    FollowedCamera followed = follow_camera(context, source, tracker, follow_);
    if (live) {
      const auto frames = static_cast<std::int64_t>(followed.reports.size());
      live->end(end_message({frames, followed.tracked_at_once, followed.interrupted}));
    }
    record.reports = std::move(followed.reports);
    record.tracking_s = followed.tracking_s;
    record.interrupted = followed.interrupted;
    record.live = std::move(followed.tally);
    record.overlays = movie.close();
    markers_ = std::move(followed.markers);
    if (followed.fault) record.warnings.emplace_back(followed.fault->what());
    return followed.fault;
  }

  void finish(const RunContext& context, const CameraTracker& tracker, const Trajectory& given, const ScaleWish& wish,
              TrackRecord& record) const {
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

  static std::string clock_of(const CameraSource& source) {
    if (source.is_live) return "host, monotonic (CLOCK_MONOTONIC), mid-exposure where the exposure is known";
    return source.frames->has_times() ? "of the recording" : "none: 1 s per frame";
  }

  LiveHello hello(const CameraSource& source, const CameraTracker& tracker) const {
    return {"track camera", source_, clock_of(source), "T_world_camera",
            tracker.localises_only() || !init_poses_.empty()};
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
  Refine refine_ = Refine::Auto;
  int lag_ = -1;
  std::optional<bool> overlay_;
  bool is_endless_ = false;  // a live camera's frames
  LiveRequest live_;
  FollowOptions follow_;
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
