// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "estimation/motion_state.h"

namespace alidade {

using Vector13d = Eigen::Matrix<double, 13, 1>;
using Matrix13d = Eigen::Matrix<double, 13, 13>;

/// The paper's state s = [d, q, v, ω]: camera centre, unit quaternion (w, x, y, z) of the rotation world → camera,
/// velocity, and ω in the paper's sense (see paper_filter.cpp), with its covariance.
struct PaperState {
  Vector13d s = Vector13d::Zero();
  Matrix13d P = Matrix13d::Zero();
};

/// The same belief in the paper's coordinates, and back. Covariances are carried over to first order.
PaperState to_paper_state(const MotionState& state);
MotionState from_paper_state(const PaperState& paper, Timestamp time);

/// The paper's measurement Jacobian of one point, ∂(pixel)/∂s, 2×13; zero where the point is not visible.
Eigen::Matrix<double, 2, 13> paper_measurement_jacobian(const Camera& camera, const Vector13d& s,
                                                        const Eigen::Vector3d& p_world);

/// One additive Kalman update with R = σ²I, then q/|q|. The gain is taken as P (I + HᵀR⁻¹H P)⁻¹ HᵀR⁻¹, equal to
/// eq. 12's P Hᵀ(H P Hᵀ + R)⁻¹ by the push-through identity, and 13×13 instead of 2n×2n.
/// Source: camera-tracker paper eqs. 8–13.
MotionState update_paper_filter(const Camera& camera, const MotionState& predicted,
                                std::span<const PointObservation> observations);

}  // namespace alidade
