// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "camera/camera.h"
#include "estimation/motion_state.h"
#include "estimation/pose_update.h"

namespace alidade {

/// Which estimator turns a frame's inliers into a pose; everything before and after it is the same.
enum class PoseMethod {
  Ekf,       ///< iterated error-state update with the map's covariance in the measurement noise
  EkfPaper,  ///< the paper's: one additive update of 13 numbers, R = σ²I
  Ukf,       ///< an unscented update, R = σ²I
  EkfSlam,   ///< camera and map points in one state; that state is the tracker's, its inliers are Ekf's
  Epnp,      ///< the frame alone: EPnP
  EpnpLm,    ///< EPnP, then Levenberg–Marquardt
  Sqpnp,     ///< the frame alone: SQPnP
};

/// Pose, covariance and inliers of a frame. The inliers are chosen alike for every method: by the gate about the
/// prediction and the robust update. `use_prior` false leaves the prediction out of the estimate itself (a fresh start,
/// a relocalisation). Empty where the observations do not determine a pose.
std::optional<PoseUpdate> estimate_pose(PoseMethod method, const Camera& camera, const MotionState& predicted,
                                        std::span<const PointObservation> observations,
                                        const PoseUpdateOptions& options, bool use_prior);

}  // namespace alidade
