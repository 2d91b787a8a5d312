// SPDX-License-Identifier: Apache-2.0
#include "marker1d/body_start.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/plane_pose_minima.h"

namespace alidade {
namespace {

// What a reading says of its marker's place before anything is known: its plane, and how far off the marker may be from
// it, at the range of the world's origin. The weights only balance the planes; update_body has the true ones.
std::vector<PlaneConstraint> constraints_of(const DetectorArray& detectors, const RigidBody& body,
                                            std::span<const LineReading> readings) {
  std::map<int, std::vector<PlaneConstraint>> of_marker;  // kept together: they are summed so
  for (const LineReading& r : readings) {
    const LineDetector& detector = detectors.at(r.detector).detector;
    const auto plane = plane_of(detector, r.value);
    const auto marker =
        std::find_if(body.markers.begin(), body.markers.end(), [&](const BodyMarker& m) { return m.id == r.marker; });
    if (plane && marker != body.markers.end()) of_marker[r.marker].push_back({marker->p_body, *plane, 1.0});
  }
  std::vector<PlaneConstraint> constraints;
  for (const auto& [id, planes] : of_marker) constraints.insert(constraints.end(), planes.begin(), planes.end());
  return constraints;
}

MotionState anywhere_near(const Eigen::Isometry3d& T_world_body, Timestamp time, const BodyStartOptions& options) {
  return resting_state(time, T_world_body, isotropic_noise(1.0, 1.0), options.speed_m_s, options.rate_rad_s);
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
  const std::vector<PlaneConstraint> constraints = constraints_of(detectors, body, readings);
  std::vector<Eigen::Isometry3d> poses;
  if (constraints.size() < 6) return poses;
  for (const PlanePose& minimum : all_minima(constraints)) {
    if (determined_directions(minimum.information) == 6) poses.push_back(minimum.T_world_body);
  }
  return poses;
}

std::vector<BodyCandidate> start_body(const DetectorArray& detectors, const RigidBody& body,
                                      std::span<const LineReading> readings, Timestamp time, double variance_factor,
                                      const BodyStartOptions& options) {
  std::vector<BodyCandidate> candidates;
  const MotionProcess known_motion{{MotionNoise{}, 1.0}};
  const double least = std::max(6.0, options.least_share * static_cast<double>(readings.size()));
  for (const Eigen::Isometry3d& T_world_body : poses_by_planes(detectors, body, readings)) {
    BodyUpdate update = update_body(BodyReadings(detectors, body, readings, variance_factor),
                                    anywhere_near(T_world_body, time, options), time, known_motion, options.update);
    if (update.inlier_count < least) continue;
    if (determined_directions(update.readings.information.topLeftCorner<6, 6>()) < 6) continue;
    candidates.push_back(
        {std::move(update.motion.state), update.log_evidence, std::move(update.is_inlier), update.inlier_count});
  }
  keep_probable(candidates, options.least_log_odds);
  return candidates;
}

}  // namespace alidade
