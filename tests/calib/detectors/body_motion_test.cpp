// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/body_motion.h"

#include <gtest/gtest.h>

#include "geometry/rotation.h"

namespace alidade {
namespace {

constexpr double kInterval = 0.02;

MotionKnot knot(double t) {
  MotionKnot k;
  k.omega_body = Eigen::Vector3d(0.7, -1.1, 2.0);
  k.R_world_body = exp_so3({0.3, -0.5, 1.0}) * exp_so3(t * k.omega_body);
  k.v_world = Eigen::Vector3d(1.0, 0.4, -0.2) + t * Eigen::Vector3d(2, -3, 1);
  k.p_world = Eigen::Vector3d(1.0, 0.4, -0.2) * t + 0.5 * t * t * Eigen::Vector3d(2, -3, 1);
  return k;
}

TEST(BodyMotion, IsExactForConstantAccelerationAndTurn) {
  for (double f : {0.0, 0.25, 0.7, 1.0}) {
    const MotionPose pose = interpolate(knot(0.1), knot(0.1 + kInterval), kInterval, f);
    const MotionKnot expected = knot(0.1 + f * kInterval);
    EXPECT_LT((pose.p_world - expected.p_world).norm(), 1e-15);
    EXPECT_LT((pose.R_world_body - expected.R_world_body).norm(), 1e-14);
  }
}

// The offset of a constant acceleration a over h: position a h²/2, velocity a h; whitened with density q the position's
// part beyond the velocity's vanishes, and the velocity's is a √h / √q.
TEST(BodyMotion, IsConstrainedToAConstantVelocity) {
  const MotionConstraint c = constrain(knot(0), knot(kInterval), kInterval, {4.0, 1.0});
  EXPECT_LT(c.residual.segment<6>(0).norm(), 1e-9);
  EXPECT_LT((c.residual.segment<3>(6) - Eigen::Vector3d(2, -3, 1) * std::sqrt(kInterval / 4.0)).norm(), 1e-12);
  EXPECT_LT(c.residual.segment<3>(9).norm(), 1e-12);
}

TEST(BodyMotion, HasTheJacobiansOfCentralDifferences) {
  const MotionKnot before = knot(0);
  MotionKnot after = knot(kInterval);
  after.omega_body += Eigen::Vector3d(0.5, 0.2, -0.3);
  const MotionPose pose = interpolate(before, after, kInterval, 0.4);
  const MotionConstraint c = constrain(before, after, kInterval, {});
  for (int i = 0; i < 12; ++i) {
    constexpr double kStep = 1e-6;
    const Vector12d step = kStep * Vector12d::Unit(i);
    for (const bool is_before : {true, false}) {
      const auto pose_at = [&](const Vector12d& d) {
        return is_before ? interpolate(moved(before, d), after, kInterval, 0.4)
                         : interpolate(before, moved(after, d), kInterval, 0.4);
      };
      const auto residual_at = [&](const Vector12d& d) {
        return is_before ? constrain(moved(before, d), after, kInterval, {}).residual
                         : constrain(before, moved(after, d), kInterval, {}).residual;
      };
      const MotionPose up = pose_at(step), down = pose_at(-step);
      Eigen::Matrix<double, 6, 1> J;
      J << (up.p_world - down.p_world) / (2 * kStep),
          log_so3(down.R_world_body.transpose() * up.R_world_body) / (2 * kStep);
      EXPECT_LT((J - (is_before ? pose.J_before : pose.J_after).col(i)).norm(), 1e-4) << i << is_before;
      const Vector12d J_c = (residual_at(step) - residual_at(-step)) / (2 * kStep);
      const Vector12d found = (is_before ? c.J_before : c.J_after).col(i);
      EXPECT_LT((J_c - found).norm(), 2e-3 * std::max(1.0, J_c.norm())) << i << is_before;
    }
  }
}

}  // namespace
}  // namespace alidade
