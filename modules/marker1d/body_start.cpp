// SPDX-License-Identifier: Apache-2.0
#include "marker1d/body_start.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "core/find_by_id.h"
#include "geometry/plane_pose_minima.h"
#include "geometry/plane_pose_search.h"
#include "geometry/plane_valley.h"
#include "marker1d/marker_plane.h"

namespace alidade {
namespace {

constexpr std::size_t kMostSearched = 48;
constexpr int kMany = 16;
constexpr double kMostWrongPosesFit = 0.75;  // a share of many readings

// Where planes nearly meet: of all of a small body's markers, whatever they are named.
Eigen::Vector3d middle_of(std::span<const Plane> planes) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Plane& plane : planes) {
    A += plane.normal * plane.normal.transpose();
    b += plane.normal * plane.offset;
  }
  return A.completeOrthogonalDecomposition().solve(b);
}

// What readings say of their markers' places before anything is known: planes about the middle of all, each as exact as
// its reading is at that range.
std::vector<PlaneConstraint> constraints_of(const DetectorArray& detectors, const RigidBody& body,
                                            std::span<const LineReading> readings, double variance_factor) {
  std::vector<Plane> planes;
  for (const LineReading& r : readings) {
    if (const auto plane = plane_of(detectors.at(r.detector).detector, r.value)) planes.push_back(*plane);
  }
  const Eigen::Vector3d middle = middle_of(planes);
  std::map<int, std::vector<PlaneConstraint>> of_marker;  // kept together: they are summed so
  for (const LineReading& r : readings) {
    const LineDetector& detector = detectors.at(r.detector).detector;
    const BodyMarker* marker = find_by_id<BodyMarker>(body.markers, r.marker);
    const auto plane = plane_about(detector, r, middle);
    if (marker == nullptr || !plane) continue;
    of_marker[r.marker].push_back({marker->p_body, plane->plane_world, plane->weight / variance_factor});
  }
  std::vector<PlaneConstraint> constraints;
  for (const auto& [id, of_one] : of_marker) constraints.insert(constraints.end(), of_one.begin(), of_one.end());
  return constraints;
}

std::vector<PlanePose> minima_of(std::span<const PlaneConstraint> constraints) {
  return constraints.size() < 6 ? std::vector<PlanePose>() : all_minima(constraints);
}

bool is_determined(const PlanePose& minimum) {
  return determined_directions(minimum.information) == 6;
}

MotionState accelerating(MotionState state, const BodyStartOptions& options) {
  state.covariance.bottomRightCorner<6, 6>() = isotropic_noise(options.acceleration_m_s2, options.acceleration_rad_s2);
  return state;
}

MotionState anywhere_near(const Eigen::Isometry3d& T_world_body, Timestamp time, const BodyStartOptions& options) {
  return accelerating(
      resting_state(time, T_world_body, isotropic_noise(1.0, 1.0), options.speed_m_s, options.rate_rad_s), options);
}

// Its evidence is that of an update from anywhere near: what fits, and how small a part of the prior the valley is.
BodyCandidate somewhere_in(const PlaneValley& valley, double chi2, std::size_t count, Timestamp time,
                           const BodyStartOptions& options) {
  const double log_volume = valley.covariance.llt().matrixL().toDenseMatrix().diagonal().array().log().sum();
  const MotionState resting =
      resting_state(time, valley.T_world_body, valley.covariance, options.speed_m_s, options.rate_rad_s);
  return {accelerating(resting, options), log_volume - chi2 / 2, std::vector<bool>(count, true),
          static_cast<int>(count)};
}

bool is_about(const MotionState& state, const Eigen::Isometry3d& T_world_body) {
  constexpr double kFarthest = 25.0;  // χ² of six degrees of freedom; an update's optimum is not quite that of planes
  const Vector6d off = difference(state.T_world_body, T_world_body);
  return off.dot(state.covariance.topLeftCorner<6, 6>().ldlt().solve(off)) < kFarthest;
}

void keep_probable(std::vector<BodyCandidate>& candidates, double least_log_odds) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const BodyCandidate& a, const BodyCandidate& b) { return a.log_evidence > b.log_evidence; });
  std::vector<BodyCandidate> kept;
  for (BodyCandidate& c : candidates) {
    const bool is_double =
        std::any_of(kept.begin(), kept.end(), [&](const BodyCandidate& k) { return is_same(k.state, c.state); });
    if (!is_double && (kept.empty() || c.log_evidence > kept.front().log_evidence - least_log_odds)) {
      kept.push_back(std::move(c));
    }
  }
  candidates = std::move(kept);
}

}  // namespace

std::vector<Eigen::Isometry3d> poses_by_planes(const DetectorArray& detectors, const RigidBody& body,
                                               std::span<const LineReading> readings) {
  std::vector<Eigen::Isometry3d> poses;
  for (const PlanePose& minimum : minima_of(constraints_of(detectors, body, readings, 1.0))) {
    if (is_determined(minimum)) poses.push_back(minimum.T_world_body);
  }
  return poses;
}

std::vector<BodyCandidate> start_body(const DetectorArray& detectors, const RigidBody& body,
                                      std::span<const LineReading> readings, Timestamp time, double variance_factor,
                                      const BodyStartOptions& options) {
  std::vector<BodyCandidate> candidates;
  const MotionProcess known_motion{{MotionNoise{}, 1.0}};
  const int count = static_cast<int>(readings.size());
  const auto try_from = [&](const Eigen::Isometry3d& T_world_body) {
    BodyUpdate update = update_body(BodyReadings(detectors, body, readings, variance_factor),
                                    anywhere_near(T_world_body, time, options), time, known_motion, options.update);
    const double least = update.inlier_count == count ? 6 : std::max(10.0, options.least_share * count);
    if (update.inlier_count < least) return;
    if (determined_directions(update.readings.information.topLeftCorner<6, 6>()) < 6) return;
    candidates.push_back(
        {std::move(update.motion.state), update.log_evidence, std::move(update.is_inlier), update.inlier_count});
  };
  const std::vector<PlaneConstraint> constraints = constraints_of(detectors, body, readings, variance_factor);
  for (const PlanePose& minimum : minima_of(constraints)) {
    if (is_determined(minimum)) {
      const std::size_t before = candidates.size();
      try_from(minimum.T_world_body);
      const bool is_held = candidates.size() > before && is_about(candidates.back().state, minimum.T_world_body);
      if (!is_held && minimum.chi2 < options.update.gate_chi2) {  // so blunt that the steps of an update leave it
        const PlaneValley itself{minimum.T_world_body, minimum.information.inverse()};
        candidates.push_back(somewhere_in(itself, minimum.chi2, readings.size(), time, options));
      }
    } else if (minimum.chi2 < options.update.gate_chi2) {
      if (const auto valley = follow_valley(constraints, minimum)) {
        candidates.push_back(somewhere_in(*valley, minimum.chi2, readings.size(), time, options));
      }
    }
  }
  keep_probable(candidates, options.least_log_odds);
  const bool is_explained =
      !candidates.empty() && candidates.front().inlier_count >= (count < kMany ? count : kMostWrongPosesFit * count);
  if (is_explained || constraints.size() < 6) return candidates;
  // Some are wrong. The search takes the body as at rest: of the last readings, which are of about one moment.
  const auto last = readings.last(std::min(readings.size(), kMostSearched));
  const PlaneSearch search = search_pose(constraints_of(detectors, body, last, variance_factor));
  for (const RobustPlanePose& found : search.candidates) try_from(found.pose.T_world_body);
  keep_probable(candidates, options.least_log_odds);
  // The one pose left explains a part of the readings; others may explain as many.
  if (candidates.size() == 1 && search.verdict != PlaneVerdict::Certain) candidates.clear();
  return candidates;
}

}  // namespace alidade
