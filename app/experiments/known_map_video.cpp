// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/known_map_video.h"

#include <algorithm>
#include <numeric>

#include "app/posed_images.h"
#include "core/errors.h"
#include "tracking/camera_tracker.h"
#include "tracking/without_rolling_shutter.h"

namespace alidade {
namespace {

constexpr std::chrono::milliseconds kLongestGap{100};  // in the truth

std::vector<PointObservation> as_found(const PointMap& map, const std::vector<FrameSighting>& sightings) {
  std::vector<PointObservation> observations;
  for (const FrameSighting& s : sightings) {
    observations.push_back(as_observation(map.points[static_cast<std::size_t>(s.point)], s.pixel, 1.0));
  }
  return observations;
}

std::vector<PointObservation> by_descriptor(const PointMap& map, const ImageFrame& frame,
                                            const CameraTrackerOptions& options) {
  std::vector<int> all(map.points.size());
  std::iota(all.begin(), all.end(), 0);
  return as_observations(
      map, match_points(map, all, detect_sift(frame.grey, options.sift), options.relocalisation_ratio), 1.0);
}

MotionState moving_as(const PosedImage& image) {
  MotionState state = resting_state(image.frame.time, image.T_world_camera, Matrix6d::Identity(), 0.0, 0.0);
  state.v_world = image.T_world_camera.linear() * image.twist.head<3>();
  state.omega_body = image.twist.tail<3>();
  return state;
}

// The motion from one image to another by the points of the first, lifted by its depth, against the true one.
std::optional<MotionResidual> truth_residual(const Camera& camera, PosedImage from, const PosedImage& to,
                                             KnownMapOptions options) {
  const Eigen::Isometry3d T_from_to = from.T_world_camera.inverse() * to.T_world_camera;
  from.T_world_camera.setIdentity();
  options.map.pose_sigma_m = options.map.pose_sigma_rad = 0.0;
  const PointMap map = with_posed_image(camera, {}, from, options.map).map;
  CameraTracker tracker(camera, options.tracker, map);
  const FrameReport found = tracker.step(to.frame);
  if (found.state != FrameState::Tracked) return std::nullopt;
  PosePrior prior;
  prior.T_world_camera = found.T_world_camera;
  const auto observations = without_rolling_shutter(camera, moving_as(to), as_found(map, found.sightings));
  const auto update = update_pose(camera, prior, observations, options.tracker.update);
  if (!update) return std::nullopt;
  return MotionResidual{difference(update->T_world_camera, T_from_to), update->covariance};
}

}  // namespace

KnownMapOptions known_map_options(const Camera& camera) {
  KnownMapOptions options;
  options.map.sift.most = options.tracker.sift.most = suggested_feature_count(camera);
  return options;
}

CameraSource open_depth_video(const std::filesystem::path& folder) {
  const std::string remedy = "give a recording in the format of the TUM RGB-D benchmark";
  CameraSource source = open_camera_source(folder.string(), {}, std::nullopt);
  if (!source.dataset || !has_depth(*source.dataset))
    throw InputError(folder.string(), 0, "has no depth images", remedy);
  if (source.dataset->truth.empty()) throw InputError(folder.string(), 0, "has no true poses", remedy);
  return source;
}

KnownMap make_known_map(CameraSource source, const KnownMapOptions& options, const ExperimentContext& context) {
  KnownMap known;
  LiveMap live;
  std::optional<PosedImage> last;
  const int total = source.frames->frame_count().value_or(0);
  while (const auto frame = next_image(source)) {
    if (context.stop.stop_requested()) return known;
    if (context.progress) context.progress({"map", frame->index + 1, total, ""});
    if (!known.frames.empty() && frame->index <= known.frames.back() + options.frames_between) continue;
    auto image = posed_image(source, *frame, source.dataset->truth);
    if (!image) continue;
    live = with_posed_image(source.camera, std::move(live), *image, options.map);
    known.frames.push_back(frame->index);
    if (last) {
      const auto residual = truth_residual(source.camera, std::move(*last), *image, options);
      if (residual) known.truth_residuals.push_back(*residual);
    }
    last = std::move(image);
  }
  known.map = std::move(live.map);
  return known;
}

std::vector<LocalisedFrame> localise_video(CameraSource source, const KnownMap& known, const KnownMapOptions& options,
                                           const ExperimentContext& context) {
  CameraTracker tracker(source.camera, options.tracker, known.map);
  std::vector<LocalisedFrame> frames;
  const int total = source.frames->frame_count().value_or(0);
  while (const auto frame = next_image(source)) {
    if (context.stop.stop_requested()) return frames;
    if (context.progress) context.progress({"track", frame->index + 1, total, ""});
    if (std::binary_search(known.frames.begin(), known.frames.end(), frame->index)) continue;
    FrameReport report = tracker.step(*frame);
    const auto T = pose_at(source.dataset->truth, frame->time, kLongestGap);
    if (!T) continue;
    auto matches = report.state == FrameState::Tracked ? as_found(known.map, report.sightings)
                                                       : by_descriptor(known.map, *frame, options.tracker);
    frames.push_back({std::move(report), *T, std::move(matches)});
  }
  return frames;
}

}  // namespace alidade
