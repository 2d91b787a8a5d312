// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "estimation/normal_equations.h"
#include "estimation/uncertain_point.h"

namespace alidade {

/// The sightings of a frame, linearised about one pose after another: for any lens, and points with covariances. Refers
/// to the camera and the observations that it is made of.
class PointwiseSightings {
 public:
  /// `variance_factor` is on the observations' sigma_px².
  PointwiseSightings(const Camera& camera, std::span<const PointObservation> observations, double variance_factor,
                     MapUncertainty map_uncertainty);

  /// Everything below is about this pose from here on. Where points are refitted, each call moves them one step.
  void linearise(const Eigen::Isometry3d& T_camera_world);

  /// Whether another call of linearise() at the same pose would change nothing.
  bool is_settled() const { return points_.empty() || map_uncertainty_ != MapUncertainty::Refitted; }

  /// Squared lengths of the whitened residuals; infinite where the camera does not see the point.
  const Eigen::ArrayXd& chi2() const { return chi2_; }

  /// An observation's ∂pixel/∂xi and beside it the residual pixel - h(pose), both in px.
  const Eigen::Matrix<double, 2, 7>& in_px(Eigen::Index i) const { return sightings_[index(i)].in_px; }

  /// Its measurement noise, px².
  Eigen::Matrix2d noise(Eigen::Index i) const { return sightings_[index(i)].R_inverse.inverse(); }

  /// The sum over all, each with its weight: one for each χ², and 0 for what is not seen.
  NormalEquations weighted_sum(const Eigen::ArrayXd& weight) const;

 private:
  struct Sighting {
    Eigen::Matrix<double, 2, 7> in_px;
    Eigen::Matrix2d R_inverse;
  };

  static std::size_t index(Eigen::Index i) { return static_cast<std::size_t>(i); }
  std::optional<UncertainSighting> sight(const Eigen::Isometry3d& T_camera_world, std::size_t i);

  const Camera& camera_;
  std::span<const PointObservation> observations_;
  double variance_factor_;
  MapUncertainty map_uncertainty_;
  std::vector<UncertainPoint> points_;  // none where all of the map is certain, or taken so
  std::vector<Sighting> sightings_;
  Eigen::ArrayXd chi2_;
};

}  // namespace alidade
