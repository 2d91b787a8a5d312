// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Eigenvalues>

#include "tests/support/motion_states.h"
#include "tests/support/synthetic_scene.h"
#include "tracking/camera_filter.h"

namespace alidade::test {

/// A draw from N(0, P); P may be singular.
template <int kSize>
Eigen::Matrix<double, kSize, 1> drawn(RandomGeometry& random, const Eigen::Matrix<double, kSize, kSize>& P) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kSize, kSize>> axes(P);
  Eigen::Matrix<double, kSize, 1> along;
  for (double& value : along) value = random.normal();
  return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).cwiseSqrt().cwiseProduct(along);
}

struct SimulatedFrame {
  MotionState truth;
  std::vector<PointObservation> observations;
};

/// What a camera sees whose motion is as the filter takes it to be.
struct SimulatedCamera {
  Camera camera = vga_camera();
  std::vector<MapPoint> points;
  MotionNoise noise;
  double dt = 1.0 / 30;
  double noise_px = 0.5;

  /// The state after a step, with what drives it drawn from the noise.
  MotionState next(const MotionState& state, RandomGeometry& random) const {
    return driven(jumped(state, drawn(random, noise.jump)), dt, drawn(random, noise.acceleration),
                  drawn(random, noise.jerk));
  }

  SimulatedFrame frame(const MotionState& truth, RandomGeometry& random) const {
    SimulatedFrame frame{truth, {}};
    for (const Sighting& s : sightings_from(camera, points, truth.T_world_body, noise_px, random)) {
      PointObservation o;
      o.pixel = s.pixel;
      o.sigma_px = s.sigma_px;
      o.p_world = points[static_cast<std::size_t>(s.point)].p_world;
      frame.observations.push_back(o);
    }
    return frame;
  }

  /// `frames` frames of a motion that goes on from `start`.
  std::vector<SimulatedFrame> recording(MotionState start, int frames, RandomGeometry& random) const {
    std::vector<SimulatedFrame> recorded;
    for (int k = 0; k < frames; ++k) recorded.push_back(frame(start = next(start, random), random));
    return recorded;
  }
};

/// A VGA camera about 6 m before `points` points, as make_map has them.
inline SimulatedCamera simulated_camera(RandomGeometry& random, int points = 60) {
  SimulatedCamera simulated;
  simulated.points = make_map(simulated.camera, points, 1, 0.0, random).points;
  return simulated;
}

/// A belief before those points: slow motion, known to about 2 cm, 5 mrad, 0.1 m/s, 0.05 rad/s and the accelerations
/// to the given sigma along each axis (m/s², rad/s²).
inline MotionState belief_before_points(double acceleration_sigma) {
  MotionState state;
  state.T_world_body = looking_at({6, 0, 0.5}, {0, 0, 0});
  state.v_world = {0.1, 0.3, -0.1};
  state.omega_body = {0.02, -0.05, 0.03};
  Vector18d sigmas;
  sigmas << Eigen::Vector3d::Constant(0.02), Eigen::Vector3d::Constant(0.005), Eigen::Vector3d::Constant(0.1),
      Eigen::Vector3d::Constant(0.05), Vector6d::Constant(acceleration_sigma);
  state.covariance = sigmas.cwiseAbs2().asDiagonal();
  return state;
}

/// The filter's steps over the frames, as far as it has an answer.
inline std::vector<MotionStep> filtered(const SimulatedCamera& simulated, MotionState state,
                                        const std::vector<SimulatedFrame>& frames, const CameraFilterOptions& options) {
  std::vector<MotionStep> steps;
  SightingNoise noise;
  for (const SimulatedFrame& frame : frames) {
    auto step = filter_step(simulated.camera, state, noise, frame.truth.time, frame.observations, options);
    if (!step) break;
    state = step->motion.state;
    noise = step->noise;
    steps.push_back(std::move(step->motion));
  }
  return steps;
}

/// Options under which all that is not known of a simulated motion is drawn from what the filter is told.
inline CameraFilterOptions options_as_simulated(const MotionNoise& noise) {
  CameraFilterOptions options;
  options.motion = {{noise, 1.0}};
  options.learn_sighting_noise = false;
  options.update.gate_chi2 = 30;  // a gate at 99.9 % would trim what is measured
  return options;
}

/// The squared error of a state in units of its own covariance: 18 in the mean where that is honest.
inline double nees(const MotionState& state, const MotionState& truth) {
  const Vector18d error = error_between(state, truth);
  return error.dot(state.covariance.ldlt().solve(error));
}

}  // namespace alidade::test
