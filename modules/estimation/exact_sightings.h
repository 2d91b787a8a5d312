// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "estimation/normal_equations.h"

namespace alidade {

/// The sightings of a frame, linearised about one pose after another: PointwiseSightings for exactly known points and a
/// lens without distortion, with the sightings side by side in arrays that the processor takes several of at a time.
class ExactSightings {
 public:
  /// `variance_factor` is on the observations' sigma_px². The camera's distortion and the points' covariances are not
  /// looked at.
  ExactSightings(const Camera& camera, std::span<const PointObservation> observations, double variance_factor);

  /// Everything below is about this pose from here on.
  void linearise(const Eigen::Isometry3d& T_camera_world);

  /// Whether another call of linearise() at the same pose would change nothing.
  static constexpr bool is_settled() { return true; }

  /// Squared lengths of the whitened residuals; infinite where the camera does not see the point. A few unseen ones
  /// after the last observation fill the array up.
  const Eigen::ArrayXd& chi2() const { return chi2_; }

  /// An observation's ∂pixel/∂xi and beside it the residual pixel - h(pose), both in px.
  Eigen::Matrix<double, 2, 7> in_px(Eigen::Index i) const;

  /// Its measurement noise, px².
  Eigen::Matrix2d noise(Eigen::Index i) const;

  /// The sum over all, each with its weight: one for each χ², and 0 for what is not seen.
  NormalEquations weighted_sum(const Eigen::ArrayXd& weight) const;

 private:
  using Array = Eigen::ArrayXd;

  Eigen::Index count_;  // of observations
  Eigen::Vector2d focal_;
  Array x_world_, y_world_, z_world_;
  Array x_pixel_, y_pixel_;  // from the principal point, in focal lengths
  Array per_variance_;       // 1/px²
  // In the camera: normalised coordinates and inverse depth, and the residuals in focal lengths.
  Array x_, y_, per_z_, x_residual_, y_residual_;
  Array chi2_;
};

}  // namespace alidade
