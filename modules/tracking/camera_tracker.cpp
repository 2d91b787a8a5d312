// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_tracker.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tracking/refinement.h"

namespace alidade {
namespace {

StarterOptions starter_options(const CameraTrackerOptions& options) {
  StarterOptions start = options.start;
  start.sift = options.sift;
  start.flow = options.flow;
  start.sigma_px = options.sigma_px;
  return start;
}

int count_inliers(const FrameReport& report) {
  return static_cast<int>(
      std::count_if(report.sightings.begin(), report.sightings.end(), [](const auto& s) { return s.is_inlier; }));
}

// Features are most of a map's memory, and what an old keyframe has left to tell is little.
void forget_old_features(LiveMap& live) {
  constexpr std::size_t kRemembered = 60;  // keyframes: about 100 MB
  if (live.features.size() > kRemembered) live.features[live.features.size() - kRemembered - 1] = {};
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

CameraTracker::CameraTracker(Camera camera, CameraTrackerOptions options, std::optional<PointMap> known_map,
                             Trajectory given_poses)
    : camera_(camera),
      options_((validate(options), std::move(options))),
      localises_only_(known_map.has_value()),
      starter_(camera_, starter_options(options_), std::move(given_poses)),
      sigma_px_(options_.sigma_px) {
  if (!known_map) return;
  live_.map = std::move(*known_map);
  live_.map.keyframes.clear();
  living_ = living_points(live_.map);
}

Localiser CameraTracker::localiser() const {
  return {camera_, live_.map, living_, options_, sigma_px_, localises_only_};
}

FrameReport CameraTracker::step(const ImageFrame& frame) {
  FlowImage flow = make_flow_image(frame.grey, options_.flow);
  if (frame.time > previous_time_ && !reports_.empty()) frame_s_ = to_seconds(frame.time - previous_time_);
  previous_time_ = frame.time;
  const bool map_is_ready = !live_.map.points.empty();
  FrameReport report = map_is_ready ? track(frame, flow) : wait(frame, flow);
  previous_ = std::move(flow);
  report.inlier_count = count_inliers(report);
  reports_.push_back(report);  // kept for refinement: the inliers alone
  reports_.back().expectations.clear();
  std::erase_if(reports_.back().sightings, [](const FrameSighting& s) { return !s.is_inlier; });
  if (!options_.will_be_refined) reports_.back().sightings = {};
  return report;
}

std::optional<TrackAnchor> CameraTracker::anchor() const {
  if (!has_pose_ || missed_ > 0) return std::nullopt;
  TrackAnchor anchor{previous_time_, previous_, motion_, {}, tracks_, sigma_px_};
  for (const FoundPoint& track : tracks_) {
    anchor.points.push_back(live_.map.points[static_cast<std::size_t>(track.point)]);
  }
  return anchor;
}

void CameraTracker::resume_from(TrackAnchor last) {
  previous_time_ = last.time;
  previous_ = std::move(last.image);
  motion_ = std::move(last.motion);
  tracks_ = std::move(last.tracks);
  has_pose_ = true;
  missed_ = 0;
}

FrameReport CameraTracker::wait(const ImageFrame& frame, const FlowImage& flow) {
  FrameReport report;
  report.index = frame.index;
  report.time = frame.time;
  report.name = frame.name;
  auto started = starter_.add(frame, flow);
  report.reason = starter_.reason();
  if (!started) return report;
  adopt(std::move(*started), frame);
  report.reason.clear();
  report.state = FrameState::Tracked;
  report.T_world_camera = motion_.state().T_world_body;
  report.covariance = motion_.state().covariance.topLeftCorner<6, 6>();
  report.is_keyframe = true;
  return report;
}

void CameraTracker::adopt(StartedMap started, const ImageFrame& frame) {
  live_ = std::move(started.live);
  anchored_keyframes_ = started.poses_were_given ? 2 : 1;
  living_ = living_points(live_.map);
  for (FrameReport& located : started.in_between) {
    for (FrameReport& report : reports_) {
      if (report.index != located.index) continue;
      report = located;
      report.inlier_count = count_inliers(report);
    }
  }
  const Keyframe& a = live_.map.keyframes[0];
  const Keyframe& b = live_.map.keyframes[1];
  for (FrameReport& report : reports_) {
    if (report.index != a.frame) continue;
    report.state = FrameState::Tracked;
    report.reason.clear();
    report.T_world_camera = a.T_world_camera;
    report.is_keyframe = true;
  }
  motion_.start({a.time, a.T_world_camera, {}}, {frame.time, b.T_world_camera, b.covariance}, frame_s_);
  has_pose_ = true;
  missed_ = 0;
  retrack_from_last_keyframe();
}

FrameReport CameraTracker::track(const ImageFrame& frame, const FlowImage& flow) {
  // 1. Predict (eqs. 1-7).
  const MotionState predicted = has_pose_ ? motion_.predicted(frame.time) : motion_.state();
  // 2. Find the map's points: by flow from the previous frame, else by SIFT near where they are expected, else
  // anywhere.
  const Localiser localiser = this->localiser();
  Localisation attempt;
  if (options_.features == FeatureMode::Sift) {
    attempt = localiser.match_every_descriptor(predicted, frame.grey, has_pose_);
    if (!localiser.is_believable(attempt)) {
      attempt = localiser.relocalise(predicted, frame.grey, std::move(attempt.features));
    }
  } else {
    if (has_pose_ && missed_ == 0) {
      attempt = localiser.follow({previous_, motion_.state().T_world_body, tracks_}, predicted, flow);
    }
    if (!localiser.is_believable(attempt) && has_pose_) attempt = localiser.search(predicted, frame.grey);
    if (!localiser.is_believable(attempt)) {
      attempt = localiser.relocalise(predicted, frame.grey, std::move(attempt.features));
    } else if (localiser.is_weak(attempt)) {  // where the motion was not foreseen, a search finds chance matches
      Localisation anywhere = localiser.relocalise(predicted, frame.grey, attempt.features);
      const bool better =
          localiser.is_believable(anywhere) && anywhere.update->inlier_count > attempt.update->inlier_count;
      if (better) attempt = std::move(anywhere);
    }
  }
  // 3. Update (eqs. 8-13), or say that the camera is lost.
  if (!localiser.is_believable(attempt)) return lose(frame, predicted);
  return accept(frame, predicted, std::move(attempt));
}

double CameraTracker::median_range(const Eigen::Isometry3d& T_world_camera,
                                   const std::vector<FoundPoint>& found) const {
  std::vector<double> ranges;
  for (const FoundPoint& f : found) {
    ranges.push_back(
        (live_.map.points[static_cast<std::size_t>(f.point)].p_world - T_world_camera.translation()).norm());
  }
  return median(std::move(ranges));
}

FrameReport CameraTracker::accept(const ImageFrame& frame, const MotionState& predicted, Localisation attempt) {
  const bool continues = has_pose_ && attempt.used_prior;
  FrameReport report;
  const bool anchor = keyframe_is_due(attempt);
  if (anchor) attempt = localiser().anchor_in_features(predicted, frame.grey, std::move(attempt));
  if (!continues) slam_.reset();
  if (options_.pose == PoseMethod::EkfSlam) attempt.update = estimate_with_map(frame.time, predicted, attempt);
  if (anchor && !localises_only_) {
    add_keyframe(frame, attempt);
    report.is_keyframe = true;
  }
  const PoseUpdate& update = *attempt.update;
  learn_sighting_noise(update);
  move_on(frame, attempt);
  if (report.is_keyframe) {
    motion_.correct(live_.map.keyframes.back().T_world_camera);
    retrack_from_last_keyframe();
  } else {
    tracks_ = inliers_of(attempt.found, update);
    if (anchor) {
      keyframe_tracks_ = tracks_.size();
      T_world_keyframe_ = update.T_world_camera;
    }
  }

  report.index = frame.index;
  report.time = frame.time;
  report.name = frame.name;
  report.state = FrameState::Tracked;
  const MotionState& now = options_.pose == PoseMethod::Ekf ? motion_.estimate() : motion_.state();
  report.T_world_camera = now.T_world_body;
  report.covariance = now.covariance.topLeftCorner<6, 6>();
  report.likelihood = update.sightings;
  report.chi2_per_dof = update.chi2_per_dof;
  report.sigma_px = sigma_px_;
  for (std::size_t i = 0; i < attempt.found.size(); ++i) {
    report.sightings.push_back({attempt.found[i].point, attempt.found[i].pixel, update.is_inlier[i]});
  }
  if (continues) report.expectations = expectations(predicted, attempt.found);
  frames_since_anchor_ = anchor ? 0 : frames_since_anchor_ + 1;
  has_pose_ = true;
  missed_ = 0;
  return report;
}

void CameraTracker::move_on(const ImageFrame& frame, const Localisation& attempt) {
  const PoseUpdate& update = *attempt.update;
  if (has_pose_ && attempt.used_prior) return motion_.follow(frame.time, update);
  const double depth_m = median_range(update.T_world_camera, attempt.found);
  if (has_pose_ && missed_ == 0) {
    motion_.jump(frame.time, update, depth_m, frame_s_);
  } else {
    motion_.find_anew(frame.time, update, depth_m, frame_s_);
  }
}

std::vector<FrameExpectation> CameraTracker::expectations(const MotionState& predicted,
                                                          const std::vector<FoundPoint>& found) const {
  const PoseBelief belief{predicted.T_world_body, predicted.covariance.topLeftCorner<6, 6>()};
  std::vector<FrameExpectation> result;
  for (const FoundPoint& f : found) {
    const auto expected = expect(camera_, belief, live_.map.points[static_cast<std::size_t>(f.point)], sigma_px_);
    result.push_back(expected ? FrameExpectation{expected->pixel, expected->S} : FrameExpectation{f.pixel, {}});
  }
  return result;
}

FrameReport CameraTracker::lose(const ImageFrame& frame, const MotionState& predicted) {
  ++missed_;
  tracks_.clear();
  if (missed_ > options_.most_predicted) has_pose_ = false;
  FrameReport report;
  report.index = frame.index;
  report.time = frame.time;
  report.name = frame.name;
  report.state = has_pose_ ? FrameState::Predicted : FrameState::Lost;
  report.reason = "too few map points found again (blur, darkness, or a part of the scene that the map lacks)";
  if (has_pose_) {
    motion_.pass(frame.time);
    report.T_world_camera = predicted.T_world_body;
    report.covariance = predicted.covariance.topLeftCorner<6, 6>();
  }
  return report;
}

bool CameraTracker::keyframe_is_due(const Localisation& attempt) const {
  if (attempt.features && options_.features == FeatureMode::Auto) return true;  // flow has failed: stills, or a jump
  if (localises_only_ && frames_since_anchor_ >= options_.anchor_every) return true;
  const PoseUpdate& update = *attempt.update;
  if (update.inlier_count < options_.keyframe_share * static_cast<double>(keyframe_tracks_)) return true;
  std::vector<double> angles;
  for (const FoundPoint& f : attempt.found) {
    const Eigen::Vector3d& p = live_.map.points[static_cast<std::size_t>(f.point)].p_world;
    const Eigen::Vector3d a = (p - T_world_keyframe_.translation()).normalized();
    const Eigen::Vector3d b = (p - update.T_world_camera.translation()).normalized();
    angles.push_back(std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  return median(std::move(angles)) > options_.keyframe_parallax_deg * std::numbers::pi / 180.0;
}

void CameraTracker::add_keyframe(const ImageFrame& frame, Localisation& attempt) {
  NewKeyframe added;
  added.keyframe = {frame.index, frame.time, frame.name, attempt.update->T_world_camera, attempt.update->covariance,
                    {}};
  added.features = *attempt.features;
  if (options_.will_be_refined) added.grey = frame.grey;
  added.found = inliers_of(attempt.found, *attempt.update);
  live_ = with_keyframe(std::move(live_), std::move(added), options_.sigma_px);
  if (!options_.local_refinement) live_ = with_retriangulated_points(camera_, std::move(live_));
  live_ = with_new_points(camera_, std::move(live_), frame.colour.empty() ? frame.grey : frame.colour, options_.growth);
  if (options_.local_refinement) {
    live_ = refine_locally(camera_, std::move(live_), anchored_keyframes_, options_.window, options_.most_fixed);
  }
  if (!options_.will_be_refined) forget_old_features(live_);
  living_ = living_points(live_.map);
}

void CameraTracker::retrack_from_last_keyframe() {
  tracks_.clear();
  const Keyframe& last = live_.map.keyframes.back();
  for (const Sighting& s : last.sightings) tracks_.push_back({s.point, -1, s.pixel});
  if (static_cast<int>(tracks_.size()) > options_.most_tracks) {
    // Every n-th keeps the spread over the image that the sightings have.
    std::vector<FoundPoint> thinned;
    const double stride = static_cast<double>(tracks_.size()) / options_.most_tracks;
    for (int i = 0; i < options_.most_tracks; ++i) thinned.push_back(tracks_[static_cast<std::size_t>(i * stride)]);
    tracks_ = std::move(thinned);
  }
  keyframe_tracks_ = tracks_.size();
  T_world_keyframe_ = last.T_world_camera;
}

// The inliers are the localiser's; pose and covariance become those of the filter that has points in its state.
PoseUpdate CameraTracker::estimate_with_map(Timestamp time, const MotionState& predicted, const Localisation& attempt) {
  PoseUpdate update = *attempt.update;
  if (slam_) {
    const SlamFrame frame{time, motion_.noise(), inliers_of(attempt.found, update), sigma_px_};
    slam_ = follow(camera_, *slam_, live_.map, living_, frame, options_.slam_points);
  }
  if (!slam_ || !slam_->state.camera.T_world_body.matrix().allFinite()) {  // this frame starts it
    slam_ = SlamTrack{slam_state(absorb(predicted, update.T_world_camera, update.covariance)), {}};
    slam_->state.camera.time = time;
  }
  update.T_world_camera = slam_->state.camera.T_world_body;
  update.covariance = slam_->state.covariance.topLeftCorner<6, 6>();
  return update;
}

void CameraTracker::learn_sighting_noise(const PoseUpdate& update) {
  if (update.inlier_count < 2 * options_.least_inliers) return;
  // The gate cuts the tails, which the running mean forgives; the bounds keep a bad start from closing the gate.
  const double variance = sigma_px_ * sigma_px_ * (0.9 + 0.1 * update.chi2_per_dof);
  sigma_px_ = std::clamp(std::sqrt(variance), 0.3 * options_.sigma_px, 3.0 * options_.sigma_px);
}

}  // namespace alidade
