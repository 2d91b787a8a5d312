// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tests/support/motion_states.h"
#include "tests/support/synthetic_scene.h"
#include "tracking/camera_filter.h"

namespace alidade::test {

/// A draw from N(0, P); P may be singular.
Eigen::VectorXd drawn(RandomGeometry& random, const Eigen::MatrixXd& P);

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
  MotionState next(const MotionState& state, RandomGeometry& random) const;

  SimulatedFrame frame(const MotionState& truth, RandomGeometry& random) const;

  /// `frames` frames of a motion that goes on from `start`.
  std::vector<SimulatedFrame> recording(MotionState start, int frames, RandomGeometry& random) const;
};

/// A VGA camera about 6 m before `points` points, as make_map has them.
SimulatedCamera simulated_camera(RandomGeometry& random, int points = 60);

/// A belief before those points: slow motion, known to about 2 cm, 5 mrad, 0.1 m/s, 0.05 rad/s and the accelerations
/// to the given sigma along each axis (m/s², rad/s²).
MotionState belief_before_points(double acceleration_sigma);

/// The filter's steps over the frames, as far as it has an answer.
std::vector<MotionStep> filtered(const SimulatedCamera& simulated, MotionState state,
                                 const std::vector<SimulatedFrame>& frames, const CameraFilterOptions& options);

/// Options under which all that is not known of a simulated motion is drawn from what the filter is told.
CameraFilterOptions options_as_simulated(const MotionNoise& noise);

/// The squared error of a state in units of its own covariance: 18 in the mean where that is honest.
double nees(const MotionState& state, const MotionState& truth);

}  // namespace alidade::test
