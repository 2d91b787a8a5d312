// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_tracker.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/LU>
#include <fmt/format.h>

#include "reconstruction/bundle_covariance.h"
#include "reconstruction/resection.h"

namespace alidade {
namespace {

StarterOptions starter_options(const CameraTrackerOptions& options) {
  StarterOptions start = options.start;
  start.sift = options.sift;
  start.flow = options.flow;
  start.sigma_px = options.sigma_px;
  return start;
}

// The keyframe of the tracker's belief must not look surer of the pose than a search window of a few pixels needs.
PoseBelief belief_of(const Eigen::Isometry3d& T, const Matrix6d& covariance, double inflation = 1.0) {
  return {T, inflation * covariance};
}

std::vector<int> points_of(const std::vector<FoundPoint>& found) {
  std::vector<int> points;
  for (const FoundPoint& f : found) points.push_back(f.point);
  return points;
}

std::vector<FoundPoint> inliers_of(const std::vector<FoundPoint>& found, const PoseUpdate& update) {
  std::vector<FoundPoint> inliers;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (update.is_inlier[i]) inliers.push_back(found[i]);
  }
  return inliers;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void require(bool holds, const char* field, double value, const char* bound) {
  if (!holds) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
}

}  // namespace

int suggested_feature_count(const Camera& camera) {
  return std::clamp(camera.width * camera.height / 100, 1000, 6000);
}

void validate(const CameraTrackerOptions& o) {
  require(o.sigma_px > 0, "sigma_px", o.sigma_px, "> 0 px");
  require(o.sift.most >= 50, "sift.most", o.sift.most, ">= 50");
  require(o.least_inliers >= 6, "least_inliers", o.least_inliers, ">= 6");
  require(o.most_tracks >= o.least_inliers, "most_tracks", o.most_tracks, ">= least_inliers");
  require(o.window >= 2, "window", o.window, ">= 2 keyframes");
  require(o.keyframe_share > 0 && o.keyframe_share <= 1, "keyframe_share", o.keyframe_share, "in (0, 1]");
  require(o.start.two_view.least_parallax_deg > 0, "start.two_view.least_parallax_deg",
          o.start.two_view.least_parallax_deg, "> 0 deg");
}

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

FrameReport CameraTracker::step(const ImageFrame& frame) {
  FlowImage flow = make_flow_image(frame.grey, options_.flow);
  const bool map_is_ready = !live_.map.points.empty();
  FrameReport report = map_is_ready ? track(frame, flow) : wait(frame, flow);
  previous_ = std::move(flow);
  reports_.push_back(report);  // kept for refinement: the inliers alone
  reports_.back().expectations.clear();
  std::erase_if(reports_.back().sightings, [](const FrameSighting& s) { return !s.is_inlier; });
  return report;
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
  report.T_world_camera = state_.T_world_camera;
  report.covariance = state_.covariance.topLeftCorner<6, 6>();
  report.is_keyframe = true;
  return report;
}

void CameraTracker::adopt(StartedMap started, const ImageFrame& frame) {
  live_ = std::move(started.live);
  anchored_keyframes_ = started.poses_were_given ? 2 : 1;
  living_ = living_points(live_.map);
  for (FrameReport& located : started.in_between) {
    for (FrameReport& report : reports_) {
      if (report.index == located.index) report = located;
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
  const double dt = std::max(1e-6, to_seconds(frame.time - a.time));
  const Vector6d motion = difference(a.T_world_camera, b.T_world_camera);
  const double speed = motion.head<3>().norm() / dt;
  const double turn_rate = motion.tail<3>().norm() / dt;
  state_ = resting_state(frame.time, b.T_world_camera, b.covariance + 1e-12 * Matrix6d::Identity(), speed,
                         std::max(turn_rate, 0.1 / dt));
  state_.v_world = (b.T_world_camera.translation() - a.T_world_camera.translation()) / dt;
  state_.omega_camera = motion.tail<3>() / dt;
  // One step's time is not known yet; the pair's is an upper bound, so these are corrected upwards by adapt().
  noise_ = {speed / dt, std::max(turn_rate, 0.05 / dt) / dt};
  has_pose_ = true;
  missed_ = 0;
  retrack_from_last_keyframe();
}

FrameReport CameraTracker::track(const ImageFrame& frame, const FlowImage& flow) {
  // 1. Predict (eqs. 1-7).
  const CameraState predicted = has_pose_ ? predict(state_, frame.time, noise_) : state_;
  // 2. Find the map's points: by flow from the previous frame, else by SIFT near where they are expected, else
  // anywhere.
  Attempt attempt;
  if (options_.features == FeatureMode::Sift) {
    attempt = match_every_descriptor(predicted, frame);
  } else {
    if (has_pose_ && missed_ == 0) attempt = follow(predicted, flow);
    if (!is_believable(attempt) && has_pose_) attempt = search(predicted, frame);
    if (!is_believable(attempt)) {
      attempt = relocalise(predicted, frame, std::move(attempt.features));
    } else if (is_weak(attempt)) {  // where the motion was not foreseen, a search about it finds chance matches
      Attempt anywhere = relocalise(predicted, frame, attempt.features);
      if (is_believable(anywhere) && anywhere.update->inlier_count > attempt.update->inlier_count) attempt = anywhere;
    }
  }
  // 3. Update (eqs. 8-13), or say that the camera is lost.
  if (!is_believable(attempt)) return lose(frame, predicted);
  return accept(frame, predicted, std::move(attempt));
}

CameraTracker::Attempt CameraTracker::follow(const CameraState& predicted, const FlowImage& flow) const {
  std::vector<Eigen::Vector2d> from, guesses;
  for (const FoundPoint& track : tracks_) {
    const Eigen::Vector3d& p = live_.map.points[static_cast<std::size_t>(track.point)].p_world;
    const auto before = project(camera_, state_.T_world_camera.inverse() * p);
    const auto after = project(camera_, predicted.T_world_camera.inverse() * p);
    from.push_back(track.pixel);
    // The difference of two projections leaves out what the map and the last pose are off by.
    guesses.push_back(before && after ? track.pixel + after->pixel - before->pixel : track.pixel);
  }
  Attempt attempt;
  const auto followed = follow_points(previous_, flow, from, guesses, options_.flow);
  for (std::size_t i = 0; i < followed.size(); ++i) {
    if (followed[i]) attempt.found.push_back({tracks_[i].point, -1, *followed[i]});
  }
  const double fewest = std::max(30.0, options_.least_flow_share * static_cast<double>(tracks_.size()));
  if (static_cast<double>(attempt.found.size()) < fewest) return {};
  attempt.update = estimate(predicted, attempt.found, true);
  if (attempt.update && attempt.update->inlier_count < fewest) return {};
  return attempt;
}

CameraTracker::Attempt CameraTracker::search(const CameraState& predicted, const ImageFrame& frame) const {
  Attempt attempt;
  attempt.features = detect_sift(frame.grey, options_.sift);
  SearchOptions near;
  near.sigma_px = sigma_px_;
  const std::vector<bool> none_taken(static_cast<std::size_t>(attempt.features->size()), false);
  attempt.found = search_points(camera_, live_.map, living_,
                                belief_of(predicted.T_world_camera, predicted.covariance.topLeftCorner<6, 6>()),
                                *attempt.features, none_taken, near);
  attempt.update = estimate(predicted, attempt.found, true);
  if (!is_believable(attempt)) return attempt;
  return widen(predicted, std::move(attempt));
}

CameraTracker::Attempt CameraTracker::relocalise(const CameraState& predicted, const ImageFrame& frame,
                                                 std::optional<Features> features) const {
  Attempt attempt;
  attempt.used_prior = false;
  attempt.features = features ? std::move(features) : detect_sift(frame.grey, options_.sift);
  RansacPnpOptions ransac;
  ransac.threshold_px = 4.0 * sigma_px_;
  ransac.least_inliers = options_.least_inliers;
  std::vector<FoundPoint> matches;
  std::optional<RansacPose> pose;
  for (const std::vector<int>& candidates : {recent_points(), living_}) {  // the likely part of the map first
    matches = match_points(live_.map, candidates, *attempt.features, options_.relocalisation_ratio);
    pose = solve_pnp_ransac(camera_, as_observations(live_.map, matches, sigma_px_), ransac);
    if (pose) break;
  }
  if (!pose) return attempt;
  for (int i : pose->inliers) attempt.found.push_back(matches[static_cast<std::size_t>(i)]);
  CameraState start = predicted;
  start.T_world_camera = pose->T_world_camera;
  attempt.update = estimate(start, attempt.found, false);
  if (!attempt.update) return attempt;
  return widen(start, std::move(attempt));
}

std::vector<int> CameraTracker::recent_points() const {
  std::vector<int> recent;
  const auto& keyframes = live_.map.keyframes;
  for (std::size_t k = keyframes.size() > 4 ? keyframes.size() - 4 : 0; k < keyframes.size(); ++k) {
    for (const Sighting& s : keyframes[k].sightings) recent.push_back(s.point);
  }
  std::sort(recent.begin(), recent.end());
  recent.erase(std::unique(recent.begin(), recent.end()), recent.end());
  return recent;
}

// With the pose nearly known, the other points of the map are looked for close to where they must be.
CameraTracker::Attempt CameraTracker::widen(const CameraState& predicted, Attempt first) const {
  Attempt wide = std::move(first);
  SearchOptions near;
  near.sigma_px = 1.5 * sigma_px_;
  near.most_radius_px = 12.0;
  const std::vector<bool> none_taken(static_cast<std::size_t>(wide.features->size()), false);
  const PoseBelief belief = belief_of(wide.update->T_world_camera, wide.update->covariance, 4.0);
  auto found = search_points(camera_, live_.map, living_, belief, *wide.features, none_taken, near);
  if (found.size() < wide.found.size()) return wide;
  CameraState start = predicted;
  if (!wide.used_prior) start.T_world_camera = wide.update->T_world_camera;
  const auto update = estimate(start, found, wide.used_prior);
  if (!update || update->inlier_count < wide.update->inlier_count) return wide;
  wide.found = std::move(found);
  wide.update = update;
  return wide;
}

CameraTracker::Attempt CameraTracker::match_every_descriptor(const CameraState& predicted,
                                                             const ImageFrame& frame) const {
  Attempt attempt;
  attempt.features = detect_sift(frame.grey, options_.sift);
  attempt.found = match_points(live_.map, living_, *attempt.features, options_.relocalisation_ratio);
  if (has_pose_) attempt.update = estimate(predicted, attempt.found, true);
  if (is_believable(attempt)) return attempt;
  return relocalise(predicted, frame, std::move(attempt.features));
}

std::optional<PoseUpdate> CameraTracker::estimate(const CameraState& predicted, const std::vector<FoundPoint>& found,
                                                  bool use_prior) const {
  const auto observations = as_observations(live_.map, found, sigma_px_);
  PoseUpdateOptions update = options_.update;
  update.map_covariance = options_.pose != PoseMethod::EkfPaper && update.map_covariance;
  const auto estimate_with = [&](const CameraState& moving) {
    return estimate_pose(options_.pose, camera_, predicted, without_rolling_shutter(camera_, moving, observations),
                         update, use_prior);
  };
  const bool rolls = camera_.readout_s > 0 && localises_only_ && use_prior;
  if (!rolls) return estimate_pose(options_.pose, camera_, predicted, observations, update, use_prior);
  const auto first = estimate_with(predicted);  // the velocity is a guess yet; the pose that it gives tells it better
  return first ? estimate_with(absorb(predicted, first->T_world_camera, first->covariance)) : first;
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

bool CameraTracker::is_believable(const Attempt& attempt) const {
  if (!attempt.update || attempt.update->inlier_count < options_.least_inliers) return false;
  return attempt.update->inlier_count >= options_.least_inlier_share * static_cast<double>(attempt.found.size());
}

bool CameraTracker::is_weak(const Attempt& attempt) const {
  if (!attempt.features || live_.map.keyframes.empty()) return false;
  const auto known = static_cast<double>(live_.map.keyframes.back().sightings.size());
  return attempt.update->inlier_count < options_.weak_share * known;
}

FrameReport CameraTracker::accept(const ImageFrame& frame, const CameraState& predicted, Attempt attempt) {
  const bool continues = has_pose_ && attempt.used_prior;
  FrameReport report;
  const bool anchor = keyframe_is_due(attempt);
  if (anchor) anchor_in_features(frame, predicted, attempt);
  if (anchor && !localises_only_) {
    add_keyframe(frame, attempt);
    report.is_keyframe = true;
  }
  const PoseUpdate& update = *attempt.update;
  learn_noise(update);
  CameraState next = absorb(predicted, update.T_world_camera, update.covariance);
  if (continues) {
    noise_ = adapt(noise_, state_, next, 0.1);
  } else if (has_pose_ && missed_ == 0) {  // a jump that the motion model did not foresee: open the gate at once
    noise_ = adapt(noise_, state_, next, 0.5);
  } else {
    // Found anew, its motion is unknown: a hand turns by a radian per second and crosses half the depth in one.
    const double depth = median_range(update.T_world_camera, attempt.found);
    next = resting_state(frame.time, update.T_world_camera, update.covariance, 0.5 * depth, 1.0);
    noise_ = {2.0 * depth, 10.0};
  }
  if (report.is_keyframe) {
    next.T_world_camera = live_.map.keyframes.back().T_world_camera;
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
  report.T_world_camera = next.T_world_camera;
  report.covariance = update.covariance;
  report.chi2_per_dof = update.chi2_per_dof;
  report.sigma_px = sigma_px_;
  for (std::size_t i = 0; i < attempt.found.size(); ++i) {
    report.sightings.push_back({attempt.found[i].point, attempt.found[i].pixel, update.is_inlier[i]});
  }
  if (continues) report.expectations = expectations(predicted, attempt.found);
  frames_since_anchor_ = anchor ? 0 : frames_since_anchor_ + 1;
  state_ = next;
  has_pose_ = true;
  missed_ = 0;
  return report;
}

std::vector<FrameExpectation> CameraTracker::expectations(const CameraState& predicted,
                                                          const std::vector<FoundPoint>& found) const {
  const PoseBelief belief = belief_of(predicted.T_world_camera, predicted.covariance.topLeftCorner<6, 6>());
  std::vector<FrameExpectation> result;
  for (const FoundPoint& f : found) {
    const auto expected = expect(camera_, belief, live_.map.points[static_cast<std::size_t>(f.point)], sigma_px_);
    result.push_back(expected ? FrameExpectation{expected->pixel, expected->S} : FrameExpectation{f.pixel, {}});
  }
  return result;
}

FrameReport CameraTracker::lose(const ImageFrame& frame, const CameraState& predicted) {
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
    state_ = predicted;
    report.T_world_camera = predicted.T_world_camera;
    report.covariance = predicted.covariance.topLeftCorner<6, 6>();
  }
  return report;
}

bool CameraTracker::keyframe_is_due(const Attempt& attempt) const {
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

// Followed points take the place of the feature near by, and the rest of the map is looked for close to where it must
// be: what flow has drifted is taken back, what it has lost returns.
void CameraTracker::anchor_in_features(const ImageFrame& frame, const CameraState& predicted, Attempt& attempt) const {
  if (!attempt.features) attempt.features = detect_sift(frame.grey, options_.sift);
  std::vector<FoundPoint> found =
      snapped_to_features(inliers_of(attempt.found, *attempt.update), *attempt.features, localises_only_);
  std::vector<bool> taken(static_cast<std::size_t>(attempt.features->size()), false);
  for (const FoundPoint& f : found) {
    if (f.feature >= 0) taken[static_cast<std::size_t>(f.feature)] = true;
  }
  std::vector<int> have = points_of(found);
  std::sort(have.begin(), have.end());
  std::vector<int> others;
  std::set_difference(living_.begin(), living_.end(), have.begin(), have.end(), std::back_inserter(others));
  SearchOptions near;
  near.sigma_px = sigma_px_;
  near.most_radius_px = 10.0;
  const auto more = search_points(camera_, live_.map, others,
                                  belief_of(attempt.update->T_world_camera, attempt.update->covariance, 4.0),
                                  *attempt.features, taken, near);
  found.insert(found.end(), more.begin(), more.end());

  CameraState start = predicted;
  if (!attempt.used_prior) start.T_world_camera = attempt.update->T_world_camera;
  const auto update = estimate(start, found, attempt.used_prior);
  if (!update || update->inlier_count < options_.least_inliers) return;
  if (localises_only_ && update->inlier_count < attempt.update->inlier_count / 3) return;  // a blurred image
  attempt.found = std::move(found);
  attempt.update = update;
}

void CameraTracker::add_keyframe(const ImageFrame& frame, Attempt& attempt) {
  NewKeyframe added;
  added.keyframe = {frame.index, frame.time, frame.name, attempt.update->T_world_camera, attempt.update->covariance,
                    {}};
  added.features = *attempt.features;
  added.grey = frame.grey;
  added.found = inliers_of(attempt.found, *attempt.update);
  live_ = with_keyframe(std::move(live_), std::move(added), options_.sigma_px);
  if (!options_.local_refinement) live_ = with_retriangulated_points(camera_, std::move(live_));
  live_ = with_new_points(camera_, std::move(live_), frame.colour.empty() ? frame.grey : frame.colour, options_.growth);
  if (options_.local_refinement) refine_locally();
  living_ = living_points(live_.map);
}

std::vector<FoundPoint> CameraTracker::snapped_to_features(const std::vector<FoundPoint>& found,
                                                           const Features& features, bool drop_others) const {
  const FeatureGrid grid(features, 16.0);
  std::vector<bool> taken(static_cast<std::size_t>(features.size()), false);
  std::vector<FoundPoint> snapped;
  GuidedOptions loose;
  loose.ratio = 1.0;
  for (const FoundPoint& f : found) {
    if (f.feature >= 0) {
      taken[static_cast<std::size_t>(f.feature)] = true;
      snapped.push_back(f);
      continue;
    }
    const Descriptor& bytes = live_.map.points[static_cast<std::size_t>(f.point)].descriptor;
    const cv::Mat row = descriptor_rows({&bytes});
    const auto feature = best_candidate(features, grid.within(f.pixel, 2.0), row.ptr<float>(0), loose);
    if (feature && !taken[static_cast<std::size_t>(*feature)]) {
      taken[static_cast<std::size_t>(*feature)] = true;
      snapped.push_back({f.point, *feature, features.pixels[static_cast<std::size_t>(*feature)]});
    } else if (!drop_others) {
      snapped.push_back(f);
    }
  }
  return snapped;
}

void CameraTracker::refine_locally() {
  const int last = static_cast<int>(live_.map.keyframes.size()) - 1;
  BundleOptions bundle;
  bundle.max_iterations = 8;
  for (int k = std::max(anchored_keyframes_, last - options_.window + 1); k <= last; ++k) {
    bundle.free_keyframes.push_back(k);
  }
  // The keyframes that hold them: those that share most points with the newest, and always the oldest anchors.
  const int first_free = bundle.free_keyframes.front();
  const std::vector<int> shared = shared_points(live_.map, last);
  std::vector<std::pair<int, int>> ranked;
  for (int k = 0; k < first_free; ++k) {
    if (shared[static_cast<std::size_t>(k)] > 10 || k >= first_free - 2) {
      ranked.emplace_back(-shared[static_cast<std::size_t>(k)], k);
    }
  }
  std::sort(ranked.begin(), ranked.end());
  for (std::size_t i = 0; i < ranked.size() && static_cast<int>(i) < options_.most_fixed; ++i) {
    bundle.fixed_keyframes.push_back(ranked[i].second);
  }
  live_.map = adjust_bundle(camera_, std::move(live_.map), bundle).map;
  live_.map = remove_outlying_sightings(camera_, std::move(live_.map), 4.0).map;
  release_removed_sightings(live_);
  live_.map = with_covariances(camera_, std::move(live_.map), bundle);
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

void CameraTracker::learn_noise(const PoseUpdate& update) {
  if (update.inlier_count < 2 * options_.least_inliers) return;
  // The gate cuts the tails, which the running mean forgives; the bounds keep a bad start from closing the gate.
  const double variance = sigma_px_ * sigma_px_ * (0.9 + 0.1 * update.chi2_per_dof);
  sigma_px_ = std::clamp(std::sqrt(variance), 0.3 * options_.sigma_px, 3.0 * options_.sigma_px);
}

}  // namespace alidade
