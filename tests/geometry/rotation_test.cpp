// SPDX-License-Identifier: Apache-2.0
#include "geometry/rotation.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr unsigned kSeed = 3;

TEST(Skew, IsTheCrossProduct) {
  const Eigen::Vector3d v(1, 2, 3), w(-4, 5, 0.5);
  EXPECT_EQ(skew(v) * w, v.cross(w));
}

TEST(ExpSo3, TurnsXIntoYByAQuarterAboutZ) {
  EXPECT_TRUE((exp_so3({0, 0, kPi / 2}) * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-15));
}

TEST(ExpSo3, IsARotationAtEveryAngle) {
  test::RandomGeometry random(kSeed);
  for (double angle : {0.0, 1e-300, 1e-12, 1e-6, 0.99e-4, 1.01e-4, 1e-3, 0.5, kPi - 1e-9, kPi, 5.0}) {
    const Eigen::Matrix3d R = exp_so3(angle * random.direction());
    EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 4e-15) << angle;
    EXPECT_NEAR(R.determinant(), 1.0, 1e-15) << angle;
  }
}

// Eigen's AngleAxis takes the axis apart from the angle and so loses nothing at small angles.
TEST(ExpSo3, AgreesWithAngleAndAxis) {
  test::RandomGeometry random(kSeed);
  for (double angle : {1e-12, 1e-6, 0.99e-4, 1.01e-4, 0.1, 3.0}) {
    const Eigen::Vector3d axis = random.direction();
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    EXPECT_LT((exp_so3(angle * axis) - expected).cwiseAbs().maxCoeff(), 1e-15) << angle;
  }
}

TEST(LogSo3, InvertsExpWithoutLossAtSmallAngles) {
  test::RandomGeometry random(kSeed);
  for (double angle : {0.0, 1e-100, 1e-15, 1e-12, 1e-9, 1e-8, 1e-6, 1e-4, 1e-2, 1.0, 3.0}) {
    const Eigen::Vector3d phi = angle * random.direction();
    EXPECT_LE((log_so3(exp_so3(phi)) - phi).norm(), 1e-12 * angle) << angle;
  }
}

TEST(LogSo3, InvertsExpNearHalfATurn) {
  test::RandomGeometry random(kSeed);
  for (double short_of_pi : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const Eigen::Vector3d phi = (kPi - short_of_pi) * random.direction();
    EXPECT_LT((log_so3(exp_so3(phi)) - phi).norm(), 1e-12) << short_of_pi;
  }
}

TEST(LogSo3, GivesOneOfTheTwoAxesAtHalfATurn) {
  for (const Eigen::Vector3d axis : {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()}) {
    const Eigen::Vector3d phi = log_so3(exp_so3(kPi * axis));
    EXPECT_NEAR(phi.norm(), kPi, 1e-12);
    EXPECT_NEAR(std::abs(phi.normalized().dot(axis)), 1.0, 1e-12);
  }
}

TEST(LogSo3, TakesTheShortWayRound) {
  EXPECT_TRUE(log_so3(exp_so3({0, 0, 4.0})).isApprox(Eigen::Vector3d(0, 0, 4.0 - 2 * kPi), 1e-12));
}

// Central differences: column i is log(exp(phi)ᵀ exp(phi + h e_i)) - log(exp(phi)ᵀ exp(phi - h e_i)) over 2h, whose
// truncation error is O(h²) and rounding error 1e-16 / h, both below 1e-9 at h = 1e-5.
TEST(RightJacobianSo3, AgreesWithCentralDifferences) {
  test::RandomGeometry random(kSeed);
  constexpr double h = 1e-5;
  for (double angle : {0.0, 1e-6, 0.99e-4, 1.01e-4, 1e-2, 1.0, 3.0, 4.5}) {
    const Eigen::Vector3d phi = angle * random.direction();
    Eigen::Matrix3d J;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
      const Eigen::Matrix3d R_inverse = exp_so3(phi).transpose();
      J.col(i) = (log_so3(R_inverse * exp_so3(phi + step)) - log_so3(R_inverse * exp_so3(phi - step))) / (2 * h);
    }
    EXPECT_LT((right_jacobian_so3(phi) - J).cwiseAbs().maxCoeff(), 1e-9) << angle;
  }
}

TEST(RightJacobianSo3, IsContinuousWhereTheSeriesTakesOver) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 3).normalized();
  const Eigen::Matrix3d change = right_jacobian_so3(1.0000001e-4 * axis) - right_jacobian_so3(0.9999999e-4 * axis);
  EXPECT_LT((change + 0.5 * skew(2e-11 * axis)).cwiseAbs().maxCoeff(), 1e-15);
}

}  // namespace
}  // namespace alidade
