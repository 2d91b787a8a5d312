// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "camera/camera.h"
#include "estimation/motion_state.h"

namespace alidade {

/// A camera and the map that it moves in, in one state: what the camera tracker leaves out of its own, to compare with.
struct SlamState {
  MotionState camera;                   ///< without accelerations; its covariance is not kept here
  std::vector<Eigen::Vector3d> points;  ///< p_world, m
  /// Of the error (xi of the pose, v_world, omega_body: 12, where the paper counts 13; then every p_world: 3M); m,
  /// rad, s.
  Eigen::MatrixXd covariance;
};

/// A camera alone. Its accelerations are taken as zero.
SlamState slam_state(const MotionState& camera);

/// The camera with its own covariance.
MotionState camera_of(const SlamState& state);

/// A point that is to enter the state.
struct SlamPoint {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_world = Eigen::Matrix3d::Zero();  ///< m²
  Eigen::MatrixX3d cross;  ///< covariance of the state's error (before any point enters) with the point; empty: none
};

/// The state with more points at its end, independent of each other. Throws std::invalid_argument for a `cross` of
/// another size.
SlamState with_points(SlamState state, std::span<const SlamPoint> points);

/// The state with only these of its points, in this order: the others are marginalised.
SlamState with_only_points(const SlamState& state, std::span<const int> kept);

/// Constant velocity; the points rest. O(M).
SlamState predict(const SlamState& state, Timestamp time, const MotionNoise& noise);

struct SlamSighting {
  int point = -1;                                   ///< index into SlamState::points
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< px
  double sigma_px = 1.0;
};

/// Where a point of the state is expected.
struct SlamMeasurement {
  Eigen::Vector2d pixel;          ///< px
  Eigen::Matrix<double, 2, 9> H;  ///< ∂pixel/∂(xi of the pose, p_world)
};

/// Empty where the point is not visible.
std::optional<SlamMeasurement> expected_measurement(const Camera& camera, const SlamState& state, int point);

/// One Kalman update of camera and points by n sightings, R = σ²I: O((12 + 3M)² n + n³). Sightings of points that the
/// prediction does not see are left out.
/// Source: Davison, Reid, Molton, Stasse, MonoSLAM, 2007, with an error state for the camera.
SlamState update_slam_filter(const Camera& camera, const SlamState& predicted, std::span<const SlamSighting> sightings);

}  // namespace alidade
