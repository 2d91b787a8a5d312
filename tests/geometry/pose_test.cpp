// SPDX-License-Identifier: Apache-2.0
#include "geometry/pose.h"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 5;

TEST(Perturbation, MovesAlongThePosesOwnAxes) {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() = exp_so3({0, std::numbers::pi / 2, 0});  // looks along +x
  Vector6d xi;
  xi << 0, 0, 2, 0, 0, 0;  // two metres forward
  EXPECT_TRUE((T_world_camera * perturbation(xi)).translation().isApprox(Eigen::Vector3d(2, 0, 0), 1e-15));
}

TEST(Perturbation, KeepsTranslationAndRotationApart) {
  Vector6d xi;
  xi << 1, 2, 3, 0.4, 0.5, 0.6;
  EXPECT_EQ(perturbation(xi).translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(perturbation(xi).linear(), exp_so3({0.4, 0.5, 0.6}));
}

TEST(Difference, IsThePerturbationThatLeadsThere) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Isometry3d from = random.pose(), to = random.pose();
    EXPECT_TRUE((from * perturbation(difference(from, to))).isApprox(to, 1e-12)) << trial;
  }
}

TEST(Interpolate, PassesThroughBothEndsAndHalfWay) {
  test::RandomGeometry random(kSeed);
  const Eigen::Isometry3d a = random.pose(), b = random.pose();
  EXPECT_TRUE(interpolate(a, b, 0.0).isApprox(a, 1e-12));
  EXPECT_TRUE(interpolate(a, b, 1.0).isApprox(b, 1e-12));
  const Eigen::Isometry3d half = interpolate(a, b, 0.5);
  EXPECT_TRUE(half.translation().isApprox(0.5 * (a.translation() + b.translation()), 1e-12));
  EXPECT_NEAR(rotation_angle(a.linear().transpose() * half.linear()),
              rotation_angle(half.linear().transpose() * b.linear()), 1e-12);
}

TEST(Interpolate, ExtrapolatesAtConstantVelocity) {
  Eigen::Isometry3d b = Eigen::Isometry3d::Identity();
  b.linear() = exp_so3({0.1, 0, 0});
  b.translation() = Eigen::Vector3d(1, 0, 0);
  const Eigen::Isometry3d ahead = interpolate(Eigen::Isometry3d::Identity(), b, 2.0);
  EXPECT_TRUE(ahead.linear().isApprox(exp_so3({0.2, 0, 0}), 1e-12));
  EXPECT_TRUE(ahead.translation().isApprox(Eigen::Vector3d(2, 0, 0), 1e-12));
}

TEST(RotationAngle, IsTheNormOfTheRotationVector) {
  EXPECT_NEAR(rotation_angle(exp_so3({0.3, -0.4, 0})), 0.5, 1e-15);
  EXPECT_NEAR(rotation_angle(exp_so3({1e-9, 0, 0})), 1e-9, 1e-21);
  EXPECT_EQ(rotation_angle(Eigen::Matrix3d::Identity()), 0.0);
}

}  // namespace
}  // namespace alidade
