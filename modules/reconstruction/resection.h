// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "geometry/pose.h"

namespace alidade {

/// The single-frame estimators that the tracker is compared with; each takes the observations alone.
enum class PnpMethod { Epnp, EpnpLm, Sqpnp };

/// Pose of a calibrated camera from map points, all of them taken as inliers and weighted alike (OpenCV's solvePnP).
/// Empty below six observations, where all points lie on one line or where the method fails. Sources: Lepetit et al.
/// 2009 (EPnP); Terzakis and Lourakis 2020 (SQPnP); LM: Levenberg–Marquardt on the reprojection error from EPnP's pose.
std::optional<Eigen::Isometry3d> solve_pnp(const Camera& camera, std::span<const PointObservation> observations,
                                           PnpMethod method);

struct RansacPose {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  std::vector<int> inliers;  ///< indices into the observations
};

struct RansacPnpOptions {
  double threshold_px = 4.0;
  int iterations = 1000;  ///< finds four inliers of 30 % with 99.97 %
  double confidence = 0.9999;
  bool sample_by_epnp = false;  ///< EPnP on five points, as it is often used; else P3P
  int least_inliers = 15;
};

/// Pose from observations with outliers: P3P (or EPnP) in RANSAC, refined on its inliers. Empty where fewer than
/// least_inliers agree. Deterministic.
std::optional<RansacPose> solve_pnp_ransac(const Camera& camera, std::span<const PointObservation> observations,
                                           const RansacPnpOptions& options = {});

/// What our filter is compared with where there are outliers: RANSAC (EPnP, at most 1000 iterations, confidence 0.99,
/// threshold 3 sigma_px), then twice EPnP + LM on all that fits within the filter's own gate. Empty where RANSAC finds
/// no pose. Deterministic.
std::optional<Eigen::Isometry3d> solve_pnp_ransac_lm(const Camera& camera,
                                                     std::span<const PointObservation> observations, double sigma_px);

/// Covariance of a pose from its observations alone: σ² (Σ Jᵀ R⁻¹ J)⁻¹, σ² from the residuals (at least 1).
/// Empty where the pose is not determined.
std::optional<Matrix6d> resection_covariance(const Camera& camera, const Eigen::Isometry3d& T_world_camera,
                                             std::span<const PointObservation> observations);

}  // namespace alidade
