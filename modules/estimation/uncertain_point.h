// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "camera/camera.h"
#include "camera/measurement.h"

namespace alidade {

/// What becomes of the covariance P_X of the map's points.
enum class MapUncertainty {
  Ignored,   ///< R_i = σ²I, as in the paper
  Inflated,  ///< R_i = σ²I + J_X P_X J_Xᵀ, with J_X and J_T taken where the map has the point
  Refitted,  ///< the same, with J_X and J_T taken where the point must be, given this sighting and the pose: the joint
             ///< optimum of pose and points. Without it, noise in depth flattens what the camera then moves round
             ///< (errors in variables).
};

/// Whether nothing is unknown of the observed point: a covariance without variances is zero.
inline bool has_exact_point(const PointObservation& observation) {
  return observation.covariance_world.diagonal() == Eigen::Vector3d::Zero();
}

/// A map point seen once more, with what is known of the point itself taken into the measurement.
struct UncertainSighting {
  Eigen::Vector2d residual;                   ///< px: the pixel minus what is expected of the point as the map has it
  Eigen::Vector3d p_camera;                   ///< m: where it was linearised
  Eigen::Matrix<double, 2, 3> J_pixel_point;  ///< ∂pixel/∂p_camera, px/m
  Eigen::Matrix2d R;                          ///< px²: σ²I + J_X P_X J_Xᵀ
};

/// What the map knows of a point, as a Gaussian in coordinates u in which triangulation errors are one: with
/// `seen_from` = a, u = (p - a) / |p - a|² (direction and inverse distance); without, u = p.
class UncertainPoint {
 public:
  /// m, m²; world frame.
  UncertainPoint(const Eigen::Vector3d& p_world, const Eigen::Matrix3d& covariance_world,
                 const std::optional<Eigen::Vector3d>& seen_from);

  bool is_certain() const { return is_certain_; }

  /// Moves the point where linearise() looks at it one Gauss–Newton step towards where it must be, given the pose and
  /// the pixel with its variance (px²). Leaves it where the camera does not see it.
  void refit(const Camera& camera, const Eigen::Isometry3d& T_camera_world, const Eigen::Vector2d& pixel,
             double variance_px2);

  /// Empty where the camera does not see the point.
  std::optional<UncertainSighting> linearise(const Camera& camera, const Eigen::Isometry3d& T_camera_world,
                                             const Eigen::Vector2d& pixel, double variance_px2) const;

 private:
  Eigen::Vector3d p_world() const;
  Eigen::Matrix3d J_world_u() const;

  bool is_certain_;
  bool is_inverse_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d u_map_;  // the map's
  Eigen::Matrix3d P_u_;    // its covariance
  Eigen::Vector3d u_;      // where it is linearised
};

}  // namespace alidade
