// SPDX-License-Identifier: Apache-2.0
#include "tracking/localiser.h"

#include <algorithm>

#include "reconstruction/resection.h"
#include "tracking/without_rolling_shutter.h"

namespace alidade {
namespace {

// Twice the standard deviations that an update states: a search about it must not miss what the update was a little
// off by.
PoseBelief loosely(const PoseUpdate& update) {
  return {update.T_world_camera, 4.0 * update.covariance};
}

std::vector<int> points_of(const std::vector<FoundPoint>& found) {
  std::vector<int> points;
  for (const FoundPoint& f : found) points.push_back(f.point);
  return points;
}

}  // namespace

std::vector<FoundPoint> inliers_of(const std::vector<FoundPoint>& found, const PoseUpdate& update) {
  std::vector<FoundPoint> inliers;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (update.is_inlier[i]) inliers.push_back(found[i]);
  }
  return inliers;
}

Localiser::Localiser(const Camera& camera, const PointMap& map, const std::vector<int>& points,
                     const CameraTrackerOptions& options, double sigma_px, bool map_is_known)
    : camera_(camera),
      map_(map),
      points_(points),
      options_(options),
      sigma_px_(sigma_px),
      map_is_known_(map_is_known) {}

Localisation Localiser::follow(const FollowedPoints& last, const MotionState& predicted, const FlowImage& flow) const {
  std::vector<Eigen::Vector2d> from, guesses;
  for (const FoundPoint& track : last.points) {
    const Eigen::Vector3d& p = map_.points[static_cast<std::size_t>(track.point)].p_world;
    const auto before = project(camera_, last.T_world_camera.inverse() * p);
    const auto after = project(camera_, predicted.T_world_body.inverse() * p);
    from.push_back(track.pixel);
    // The difference of two projections leaves out what the map and the last pose are off by.
    guesses.push_back(before && after ? track.pixel + after->pixel - before->pixel : track.pixel);
  }
  Localisation attempt;
  const auto followed = follow_points(last.image, flow, from, guesses, options_.flow);
  for (std::size_t i = 0; i < followed.size(); ++i) {
    if (followed[i]) attempt.found.push_back({last.points[i].point, -1, *followed[i]});
  }
  const double fewest = std::max(30.0, options_.least_flow_share * static_cast<double>(last.points.size()));
  if (static_cast<double>(attempt.found.size()) < fewest) return {};
  attempt.update = estimate(predicted, attempt.found, true);
  if (attempt.update && attempt.update->inlier_count < fewest) return {};
  return attempt;
}

Localisation Localiser::search(const MotionState& predicted, const cv::Mat& grey) const {
  Localisation attempt;
  attempt.features = detect_sift(grey, options_.sift);
  SearchOptions near;
  near.sigma_px = sigma_px_;
  const std::vector<bool> none_taken(static_cast<std::size_t>(attempt.features->size()), false);
  attempt.found =
      search_points(camera_, map_, points_, {predicted.T_world_body, predicted.covariance.topLeftCorner<6, 6>()},
                    *attempt.features, none_taken, near);
  attempt.update = estimate(predicted, attempt.found, true);
  if (!is_believable(attempt)) return attempt;
  return widen(predicted, std::move(attempt));
}

Localisation Localiser::relocalise(const MotionState& predicted, const cv::Mat& grey,
                                   std::optional<Features> features) const {
  Localisation attempt;
  attempt.used_prior = false;
  attempt.features = features ? std::move(features) : detect_sift(grey, options_.sift);
  RansacPnpOptions ransac;
  ransac.threshold_px = 4.0 * sigma_px_;
  ransac.least_inliers = options_.least_inliers;
  std::vector<FoundPoint> matches;
  std::optional<RansacPose> pose;
  for (const std::vector<int>& candidates : {recent_points(), points_}) {  // the likely part of the map first
    matches = match_points(map_, candidates, *attempt.features, options_.relocalisation_ratio);
    pose = solve_pnp_ransac(camera_, as_observations(map_, matches, sigma_px_), ransac);
    if (pose) break;
  }
  if (!pose) return attempt;
  for (int i : pose->inliers) attempt.found.push_back(matches[static_cast<std::size_t>(i)]);
  MotionState start = predicted;
  start.T_world_body = pose->T_world_camera;
  attempt.update = estimate(start, attempt.found, false);
  if (!attempt.update) return attempt;
  return widen(start, std::move(attempt));
}

Localisation Localiser::match_every_descriptor(const MotionState& predicted, const cv::Mat& grey,
                                               bool use_prior) const {
  Localisation attempt;
  attempt.features = detect_sift(grey, options_.sift);
  attempt.found = match_points(map_, points_, *attempt.features, options_.relocalisation_ratio);
  if (use_prior) attempt.update = estimate(predicted, attempt.found, true);
  return attempt;
}

Localisation Localiser::anchor_in_features(const MotionState& predicted, const cv::Mat& grey,
                                           Localisation attempt) const {
  if (!attempt.features) attempt.features = detect_sift(grey, options_.sift);
  std::vector<FoundPoint> found =
      snapped_to_features(inliers_of(attempt.found, *attempt.update), *attempt.features, map_is_known_);
  std::vector<bool> taken(static_cast<std::size_t>(attempt.features->size()), false);
  for (const FoundPoint& f : found) {
    if (f.feature >= 0) taken[static_cast<std::size_t>(f.feature)] = true;
  }
  std::vector<int> have = points_of(found);
  std::sort(have.begin(), have.end());
  std::vector<int> others;
  std::set_difference(points_.begin(), points_.end(), have.begin(), have.end(), std::back_inserter(others));
  SearchOptions near;
  near.sigma_px = sigma_px_;
  near.most_radius_px = 10.0;
  const auto more = search_points(camera_, map_, others, loosely(*attempt.update), *attempt.features, taken, near);
  found.insert(found.end(), more.begin(), more.end());

  MotionState start = predicted;
  if (!attempt.used_prior) start.T_world_body = attempt.update->T_world_camera;
  const auto update = estimate(start, found, attempt.used_prior);
  if (!update || update->inlier_count < options_.least_inliers) return attempt;
  if (map_is_known_ && update->inlier_count < attempt.update->inlier_count / 3) return attempt;  // a blurred image
  attempt.found = std::move(found);
  attempt.update = update;
  return attempt;
}

bool Localiser::is_believable(const Localisation& attempt) const {
  if (!attempt.update || attempt.update->inlier_count < options_.least_inliers) return false;
  return attempt.update->inlier_count >= options_.least_inlier_share * static_cast<double>(attempt.found.size());
}

bool Localiser::is_weak(const Localisation& attempt) const {
  if (!attempt.features || map_.keyframes.empty()) return false;
  const auto known = static_cast<double>(map_.keyframes.back().sightings.size());
  return attempt.update->inlier_count < options_.weak_share * known;
}

std::optional<PoseUpdate> Localiser::estimate(const MotionState& predicted, const std::vector<FoundPoint>& found,
                                              bool use_prior) const {
  const auto observations = as_observations(map_, found, sigma_px_);
  PoseUpdateOptions update = options_.update;
  if (options_.pose == PoseMethod::EkfPaper) update.map_uncertainty = MapUncertainty::Ignored;
  const auto estimate_with = [&](const MotionState& moving) {
    return estimate_pose(options_.pose, camera_, predicted, without_rolling_shutter(camera_, moving, observations),
                         update, use_prior);
  };
  const bool rolls = camera_.readout_s > 0 && map_is_known_ && use_prior;
  if (!rolls) return estimate_pose(options_.pose, camera_, predicted, observations, update, use_prior);
  const auto first = estimate_with(predicted);  // the velocity is a guess yet; the pose that it gives tells it better
  return first ? estimate_with(absorb(predicted, first->T_world_camera, first->covariance)) : first;
}

// With the pose nearly known, the other points of the map are looked for close to where they must be.
Localisation Localiser::widen(const MotionState& predicted, Localisation first) const {
  Localisation wide = std::move(first);
  SearchOptions near;
  near.sigma_px = 1.5 * sigma_px_;
  near.most_radius_px = 12.0;
  const std::vector<bool> none_taken(static_cast<std::size_t>(wide.features->size()), false);
  auto found = search_points(camera_, map_, points_, loosely(*wide.update), *wide.features, none_taken, near);
  if (found.size() < wide.found.size()) return wide;
  MotionState start = predicted;
  if (!wide.used_prior) start.T_world_body = wide.update->T_world_camera;
  const auto update = estimate(start, found, wide.used_prior);
  if (!update || update->inlier_count < wide.update->inlier_count) return wide;
  wide.found = std::move(found);
  wide.update = update;
  return wide;
}

std::vector<FoundPoint> Localiser::snapped_to_features(const std::vector<FoundPoint>& found, const Features& features,
                                                       bool drop_others) const {
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
    const Descriptor& bytes = map_.points[static_cast<std::size_t>(f.point)].descriptor;
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

std::vector<int> Localiser::recent_points() const {
  std::vector<int> recent;
  const auto& keyframes = map_.keyframes;
  for (std::size_t k = keyframes.size() > 4 ? keyframes.size() - 4 : 0; k < keyframes.size(); ++k) {
    for (const Sighting& s : keyframes[k].sightings) recent.push_back(s.point);
  }
  std::sort(recent.begin(), recent.end());
  recent.erase(std::unique(recent.begin(), recent.end()), recent.end());
  return recent;
}

}  // namespace alidade
