// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_filter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace alidade {
namespace {

constexpr double kLeastVariance = 1e-18;  // px²: where sightings are exact, rounding is all that is left
constexpr double kMostVariance = 1e4;
constexpr double kFewDegreesOfFreedom = 100;
constexpr double kMostDegreesOfFreedom = 1e5;  // the noise may change in the long run

// Whether residuals with this χ² per degree of freedom can come from noise as strong as was assumed.
bool is_plausible(double chi2_per_dof, double dof) {
  return std::abs(chi2_per_dof - 1.0) < std::max(0.1, 4.0 * std::sqrt(2.0 / dof));
}

struct MeasuredPose {
  PoseUpdate update;
  SightingNoise noise;
};

// The pose by a prior that allows for every manoeuvre, with the sightings' noise corrected until the residuals bear it
// out.
std::optional<MeasuredPose> measure(const Camera& camera, const PosePrior& prior, SightingNoise noise,
                                    std::span<const PointObservation> observations,
                                    const CameraFilterOptions& options) {
  constexpr int kMostRounds = 30;
  for (int round = 0;; ++round) {
    PoseUpdateOptions with_noise = options.update;
    with_noise.variance_factor = noise.variance;
    auto update = update_pose(camera, prior, observations, with_noise);
    if (!update) {
      const bool is_guess = options.learn_sighting_noise && noise.degrees_of_freedom < kFewDegreesOfFreedom;
      if (!is_guess || noise.variance > kMostVariance || round >= kMostRounds) return std::nullopt;
      noise = {4.0 * noise.variance, 0.0};  // the gate by the guess may be too narrow
      continue;
    }
    const double dof = 2.0 * update->inlier_count - 6.0;
    if (!options.learn_sighting_noise || dof < 1) return MeasuredPose{std::move(*update), noise};
    const double measured = std::max(kLeastVariance, noise.variance * update->chi2_per_dof);
    if (is_plausible(update->chi2_per_dof, dof) || measured == noise.variance || round >= kMostRounds) {
      const double known = std::min(noise.degrees_of_freedom, kMostDegreesOfFreedom);
      noise.variance = (known * noise.variance + dof * measured) / (known + dof);
      noise.degrees_of_freedom = known + dof;
      return MeasuredPose{std::move(*update), noise};
    }
    noise = {measured, 0.0};
  }
}

}  // namespace

std::optional<FilterStep> filter_step(const Camera& camera, const MotionState& state, const SightingNoise& noise,
                                      Timestamp time, std::span<const PointObservation> observations,
                                      const CameraFilterOptions& options) {
  // The gate must let through what any mode of the motion allows.
  const MotionState widest = predict_without_noise(state, time);
  Matrix6d P = covariance_in_map(widest);
  for (const MotionMode& mode : options.motion) {
    P += noise_covariance(state, widest, mode.noise).topLeftCorner<6, 6>();
  }
  auto measured = measure(camera, {widest.T_world_body, P.inverse()}, noise, observations, options);
  if (!measured) return std::nullopt;
  MotionStep motion = absorb(state, time, options.motion, measured->update.sightings);
  return FilterStep{std::move(motion), std::move(measured->update), measured->noise};
}

}  // namespace alidade
