// SPDX-License-Identifier: Apache-2.0
#include "estimation/uncertain_point.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/support/synthetic_scene.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 97;

// A point about 2 m before a camera that was triangulated from 1.5 m to the side, to 3 mm across and 15 cm in depth.
class UncertainPointTest : public testing::TestWithParam<bool> {
 protected:
  UncertainPointTest() {
    T_camera_world_ = test::looking_at({2, 0.3, 0.2}, {0, 0, 0}).inverse();
    p_world_ = random_.vector(0.2);
    const Eigen::Vector3d from(1.3, 1.5, 0.0), depth = (p_world_ - from).normalized();
    covariance_ = 9e-6 * Eigen::Matrix3d::Identity() + 0.0225 * depth * depth.transpose();
    if (GetParam()) seen_from_ = from;
    pixel_ = project(camera_, T_camera_world_ * (p_world_ + 0.2 * depth))->pixel + Eigen::Vector2d(1.5, -2.0);
  }

  UncertainPoint point() const { return {p_world_, covariance_, seen_from_}; }

  // The coordinates in which the point's error is Gaussian.
  Eigen::Vector3d coordinates(const Eigen::Vector3d& p) const {
    return seen_from_ ? Eigen::Vector3d((p - *seen_from_) / (p - *seen_from_).squaredNorm()) : p;
  }

  Eigen::Matrix3d jacobian_of_coordinates(const Eigen::Vector3d& p) const {
    Eigen::Matrix3d J;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(i);
      J.col(i) = (coordinates(p + step) - coordinates(p - step)) / 2e-6;
    }
    return J;
  }

  Eigen::Vector2d pixel_of(const Eigen::Vector3d& p) const { return project(camera_, T_camera_world_ * p)->pixel; }

  Eigen::Matrix<double, 2, 3> jacobian_of_pixel(const Eigen::Vector3d& p) const {
    Eigen::Matrix<double, 2, 3> J;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(i);
      J.col(i) = (pixel_of(p + step) - pixel_of(p - step)) / 2e-6;
    }
    return J;
  }

  // What the most probable point makes least: the map's belief and the pixel, each in standard deviations.
  double cost(const Eigen::Vector3d& p) const {
    const Eigen::Matrix3d J = jacobian_of_coordinates(p_world_);
    const Eigen::Vector3d off = coordinates(p) - coordinates(p_world_);
    return off.dot((J * covariance_ * J.transpose()).inverse() * off) +
           (pixel_ - pixel_of(p)).squaredNorm() / kVariance_px2;
  }

  // Gauss–Newton on the point's three world coordinates, started where the map has it.
  Eigen::Vector3d most_probable_point() const {
    const Eigen::Matrix3d J_map = jacobian_of_coordinates(p_world_);
    const Eigen::Matrix3d information = (J_map * covariance_ * J_map.transpose()).inverse();
    Eigen::Vector3d p = p_world_;
    for (int step = 0; step < 100; ++step) {
      const Eigen::Matrix3d J = jacobian_of_coordinates(p);
      const Eigen::Matrix<double, 2, 3> J_pixel = jacobian_of_pixel(p);
      const Eigen::Matrix3d A = J.transpose() * information * J + J_pixel.transpose() * J_pixel / kVariance_px2;
      const Eigen::Vector3d g = J_pixel.transpose() * (pixel_ - pixel_of(p)) / kVariance_px2 -
                                J.transpose() * information * (coordinates(p) - coordinates(p_world_));
      p += A.ldlt().solve(g);
    }
    return p;
  }

  static constexpr double kVariance_px2 = 2.25;
  test::RandomGeometry random_{kSeed};
  Camera camera_ = test::vga_camera();
  Eigen::Isometry3d T_camera_world_;
  Eigen::Vector3d p_world_;
  Eigen::Matrix3d covariance_;
  std::optional<Eigen::Vector3d> seen_from_;
  Eigen::Vector2d pixel_;
};

INSTANTIATE_TEST_SUITE_P(InEitherCoordinates, UncertainPointTest, testing::Bool(),
                         [](const auto& kind) { return kind.param ? "InverseDistance" : "World"; });

TEST_P(UncertainPointTest, IsLinearisedWhereTheMapHasIt) {
  const auto sighting = point().linearise(camera_, T_camera_world_, pixel_, kVariance_px2);
  ASSERT_TRUE(sighting);
  EXPECT_LT((sighting->p_camera - T_camera_world_ * p_world_).norm(), 1e-12);
  EXPECT_LT((sighting->residual - (pixel_ - pixel_of(p_world_))).norm(), 1e-9);
  const Eigen::Matrix<double, 2, 3> J = jacobian_of_pixel(p_world_);
  EXPECT_LT((sighting->J_pixel_point * T_camera_world_.linear() - J).norm(), 1e-5);
  const Eigen::Matrix2d R = kVariance_px2 * Eigen::Matrix2d::Identity() + J * covariance_ * J.transpose();
  EXPECT_LT((sighting->R - R).norm(), 1e-6 * R.norm());
}

TEST_P(UncertainPointTest, IsRefittedToTheMostProbablePlace) {
  const Eigen::Vector3d expected = most_probable_point();
  EXPECT_GT((expected - p_world_).norm(), 0.1);
  UncertainPoint refitted = point();
  for (int step = 0; step < 30; ++step) refitted.refit(camera_, T_camera_world_, pixel_, kVariance_px2);
  const auto sighting = refitted.linearise(camera_, T_camera_world_, pixel_, kVariance_px2);
  ASSERT_TRUE(sighting);
  EXPECT_LT((sighting->p_camera - T_camera_world_ * expected).norm(), 1e-7) << "seed " << kSeed;
}

// χ² of the whitened residual is what map and pixel together are off at best: the point is gone from the problem.
TEST_P(UncertainPointTest, HasTheLeastCostAsItsSquare) {
  UncertainPoint refitted = point();
  for (int step = 0; step < 30; ++step) refitted.refit(camera_, T_camera_world_, pixel_, kVariance_px2);
  const auto sighting = refitted.linearise(camera_, T_camera_world_, pixel_, kVariance_px2);
  ASSERT_TRUE(sighting);
  const double least = cost(most_probable_point());
  EXPECT_GT(least, 0.1);
  EXPECT_NEAR(sighting->residual.dot(sighting->R.inverse() * sighting->residual), least, 1e-6 * least);
}

TEST_P(UncertainPointTest, IsEmptyBehindTheCamera) {
  const Eigen::Isometry3d away = test::looking_at({2, 0.3, 0.2}, {4, 0.6, 0.4}).inverse();
  UncertainPoint unseen = point();
  EXPECT_FALSE(unseen.linearise(camera_, away, pixel_, kVariance_px2));
  unseen.refit(camera_, away, pixel_, kVariance_px2);
  const auto sighting = unseen.linearise(camera_, T_camera_world_, pixel_, kVariance_px2);
  ASSERT_TRUE(sighting);
  EXPECT_LT((sighting->p_camera - T_camera_world_ * p_world_).norm(), 1e-12);
}

TEST_P(UncertainPointTest, IsCertainWithoutCovariance) {
  EXPECT_FALSE(point().is_certain());
  covariance_.setZero();
  UncertainPoint certain = point();
  EXPECT_TRUE(certain.is_certain());
  certain.refit(camera_, T_camera_world_, pixel_, kVariance_px2);
  const auto sighting = certain.linearise(camera_, T_camera_world_, pixel_, kVariance_px2);
  ASSERT_TRUE(sighting);
  EXPECT_LT((sighting->p_camera - T_camera_world_ * p_world_).norm(), 1e-9);
  EXPECT_EQ(sighting->R, Eigen::Matrix2d(kVariance_px2 * Eigen::Matrix2d::Identity()));
}

}  // namespace
}  // namespace alidade
