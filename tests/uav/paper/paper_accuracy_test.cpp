// SPDX-License-Identifier: Apache-2.0
#include "uav/paper/paper_accuracy.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "uav/paper/paper_geometry.h"

namespace alidade {
namespace {

using Eigen::Vector3d;

// (AᵀA)⁻¹ of eq. 8, and of the n − 1 equations without velocity.
Eigen::MatrixXd inverse_normal_matrix(const std::vector<Vector3d>& a) {
  const auto n = static_cast<Eigen::Index>(a.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * (n - 1), n);
  for (Eigen::Index k = 1; k < n; ++k) {
    A.block<3, 1>(3 * (k - 1), 0) = a[0];
    A.block<3, 1>(3 * (k - 1), k) = -a[static_cast<std::size_t>(k)];
  }
  return (A.transpose() * A).inverse();
}

Vector3d line_at(double angle, double turn) {
  return {std::cos(angle), std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn)};
}

TEST(PaperAccuracy, TwoReceiversErrAsTheNormalMatrixSays) {
  for (const double angle : {0.2, 1.0, std::numbers::pi / 2, 2.5}) {
    const Eigen::MatrixXd expected = 0.04 * inverse_normal_matrix({line_at(0, 0), line_at(angle, 1)});
    EXPECT_LT((range_covariance(angle, 0.2) - expected).norm(), 1e-12 * expected.norm()) << angle;
  }
}

TEST(PaperAccuracy, SeveralReceiversErrAsTheNormalMatrixSays) {
  const std::vector<double> angles{0.5, 1.2, 2.0};
  const Eigen::MatrixXd K = inverse_normal_matrix({line_at(0, 0), line_at(0.5, 1), line_at(1.2, 2), line_at(2.0, 3)});
  EXPECT_NEAR(range_sigma(angles, 0.1), 0.1 * std::sqrt(K(0, 0)), 1e-12);
  EXPECT_NEAR(range_sigma(std::vector<double>{0.7}, 0.1), 0.1 / std::sin(0.7), 1e-12);
}

// The point itself errs across the first line too; along it by r₁ alone.
TEST(PaperAccuracy, ErrorsOfBearingsAreThoseOfThePairSolution) {
  Bearing first, second;
  first.direction_world = line_at(0, 0);
  second.direction_world = line_at(0.8, 0.3);
  first.origin_world = -100 * first.direction_world;
  second.origin_world = -200 * second.direction_world;
  first.covariance = second.covariance = 1e-6 * Eigen::Matrix2d::Identity();
  const auto fix = solve_pair(first, second);
  ASSERT_TRUE(fix);
  const double variance = first.direction_world.dot(fix->covariance_world * first.direction_world);
  EXPECT_NEAR(range_covariance_of_bearings(0.8, 0.1, 0.2)(0, 0), variance, 1e-12);
  const Eigen::Matrix2d turned = range_covariance_of_bearings(0.8, 0.2, 0.1);
  EXPECT_NEAR(range_covariance_of_bearings(0.8, 0.1, 0.2)(1, 1), turned(0, 0), 1e-12);
}

TEST(PaperAccuracy, IsRefusedForParallelLines) {
  EXPECT_THROW(range_covariance(0.0, 0.1), std::invalid_argument);
  EXPECT_THROW(range_covariance_of_bearings(std::numbers::pi, 0.1, 0.1), std::invalid_argument);
  EXPECT_THROW(range_sigma(std::vector<double>{0.0, 0.0}, 0.1), std::invalid_argument);
  EXPECT_NO_THROW(range_sigma(std::vector<double>{0.0, 0.1}, 0.1));
}

}  // namespace
}  // namespace alidade
