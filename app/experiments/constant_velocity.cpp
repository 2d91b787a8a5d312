// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/constant_velocity.h"

#include <Eigen/LU>

#include "tracking/map_offset.h"
#include "tracking/slam_filter.h"

namespace alidade {
namespace {

StampedPose stamped(const MotionState& state) {
  return {state.time, state.T_world_body, Matrix6d(state.covariance.topLeftCorner<6, 6>())};
}

}  // namespace

MotionState constant_velocity_start(const Trajectory& truth) {
  return camera_of(slam_state(moving_state(truth[0], truth[1])));
}

Trajectory estimate_at_constant_velocity(const CameraRun& run, MotionState state, const MotionNoise& noise,
                                         const FrameUpdate& update) {
  Trajectory estimate;
  for (std::size_t k = 2; k < run.truth.size(); ++k) {
    state = update(predict(state, run.truth[k].time, noise), run.sightings[k]);
    estimate.push_back(stamped(state));
  }
  return estimate;
}

Trajectory estimate_with_map_in_state(const Camera& camera, const CameraRun& run, const MotionState& start,
                                      const MotionNoise& noise) {
  std::vector<SlamPoint> points;
  for (const PointObservation& o : run.sightings.front()) points.push_back({o.p_world, o.covariance_world, {}});
  SlamState state = with_points(slam_state(start), points);
  Trajectory estimate;
  for (std::size_t k = 2; k < run.truth.size(); ++k) {
    std::vector<SlamSighting> sightings;
    for (const PointObservation& o : run.sightings[k]) {
      sightings.push_back({static_cast<int>(sightings.size()), o.pixel, o.sigma_px});
    }
    state = update_slam_filter(camera, predict(state, run.truth[k].time, noise), sightings);
    estimate.push_back(stamped(camera_of(state)));
  }
  return estimate;
}

FrameUpdate iterated_update(const Camera& camera) {
  PoseUpdateOptions options;  // without outliers, no gate
  options.gate_chi2 = options.loosest_gate_px = 1e6;
  return [camera, options](const MotionState& predicted, std::span<const PointObservation> observations) {
    const std::vector<PointObservation> apart =
        apart_from(predicted.map_offset, {observations.begin(), observations.end()});
    const PosePrior prior{predicted.T_world_body, covariance_in_map(predicted).inverse()};
    const auto update = update_pose(camera, prior, apart, options);
    return update ? absorb(predicted, update->sightings) : predicted;
  };
}

CameraRun with_sigma(CameraRun run, double sigma_px) {
  for (auto& sightings : run.sightings) {
    for (PointObservation& o : sightings) o.sigma_px = sigma_px;
  }
  return run;
}

}  // namespace alidade
