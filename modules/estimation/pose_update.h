// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "estimation/uncertain_point.h"
#include "geometry/pose.h"

namespace alidade {

/// What is believed of a camera's pose before its image is looked at.
struct PosePrior {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< inverse covariance of the right perturbation; zero: nothing is known
};

struct PoseUpdateOptions {
  double gate_chi2 = 13.8;        ///< a residual beyond it (2 degrees of freedom, 99.9 %) is an outlier
  double loosest_gate_px = 60.0;  ///< however uncertain the prediction, a match farther off is not considered
  int max_iterations = 12;        ///< Gauss–Newton steps of the robust phase; 5 are usual
  int least_inliers = 6;          ///< fewer leave the pose unanswered
  MapUncertainty map_uncertainty = MapUncertainty::Refitted;
  double variance_factor = 1.0;  ///< on the observations' sigma_px²
};

/// What the sightings alone say of the pose, to second order: log p(z | T_world_body * perturbation(ξ)) =
/// gradientᵀ ξ - ½ ξᵀ information ξ + constant, in m and rad.
struct PoseLikelihood {
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
};

struct PoseUpdate {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of the right perturbation, m and rad
  PoseLikelihood sightings;                ///< the inliers' share in it, about T_world_camera
  std::vector<bool> is_inlier;             ///< one per observation
  int inlier_count = 0;
  double chi2_per_dof = 0.0;  ///< of the inliers' whitened residuals; 1 where sigma_px is right
};

/// The maximum a posteriori pose from a prior and sightings of map points: iterated update in information form, O(n) in
/// the number of observations. Observations inside the gate about the prior pass a redescending weight (Geman–McClure,
/// graduated); all that fit the pose found so give pose and covariance. Empty where fewer than least_inliers pass the
/// gate or fit, or where the pose is not determined.
/// Source: camera-tracker paper eqs. 8–13 in error-state, information form; R_i as in options.
std::optional<PoseUpdate> update_pose(const Camera& camera, const PosePrior& prior,
                                      std::span<const PointObservation> observations,
                                      const PoseUpdateOptions& options = {});

/// The measurement noise of an observation, R_i (px²), for a camera at T_world_camera; empty where it is not visible.
std::optional<Eigen::Matrix2d> measurement_noise(const Camera& camera, const Eigen::Isometry3d& T_world_camera,
                                                 const PointObservation& observation, MapUncertainty map_uncertainty);

}  // namespace alidade
