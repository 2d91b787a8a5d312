// SPDX-License-Identifier: Apache-2.0
#include "camera/distortion.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

namespace alidade {
namespace {

// A pinhole, a cheap lens, two rational ones, and fisheyes without and with terms beyond the first; `widest` is how far
// off axis the tests look, rad.
struct Lens {
  Distortion distortion;
  double widest;
};
const std::vector<Lens> kLenses{
    {BrownConrady{}, 1.0},
    {BrownConrady{-0.28, 0.09, 0.001, -0.0005, -0.01}, 0.7},
    {BrownConrady{0.3, -0.2, 0.001, -0.0005, 0.05, 0.6, -0.15, 0.02}, 0.6},
    {BrownConrady{8.0, 4.0, -0.0002, 0.0001, 0.2, 8.3, 6.5, 1.1}, 0.8},
    {Fisheye{}, 2.9},
    {Fisheye{-0.03, 0.01, -0.004, 0.0005}, 1.9},
    {Fisheye{0.0035, 0.0007, -0.002, 0.0002}, 2.2},
};

// Directions of an angle off axis in twelve directions around it, each at another distance.
std::vector<Eigen::Vector3d> points_in_view(const Lens& lens) {
  std::vector<Eigen::Vector3d> points;
  for (int ring = 1; ring <= 8; ++ring) {
    const double angle = lens.widest * ring / 8;
    for (int i = 0; i < 12; ++i) {
      const double around = 0.1 + i * std::numbers::pi / 6;
      const Eigen::Vector3d direction(std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around),
                                      std::cos(angle));
      points.push_back((0.5 + i) * direction);
    }
  }
  return points;
}

TEST(Distort, AgreesWithOpenCv) {
  for (const Lens& lens : kLenses) {
    const auto* k = std::get_if<BrownConrady>(&lens.distortion);
    const DistortionCoefficients values = coefficients(lens.distortion);
    const cv::Mat list(static_cast<int>(values.size()), 1, CV_64F, const_cast<double*>(values.data()));
    for (const Eigen::Vector3d& p : points_in_view(lens)) {
      if (p.z() <= 0) continue;  // OpenCV's fisheye ends at 90 degrees
      const std::vector<cv::Point3d> point{{p.x(), p.y(), p.z()}};
      std::vector<cv::Point2d> expected;
      if (k) {
        cv::projectPoints(point, cv::Vec3d(), cv::Vec3d(), cv::Matx33d::eye(), list, expected);
      } else {
        cv::fisheye::projectPoints(point, expected, cv::Vec3d(), cv::Vec3d(), cv::Matx33d::eye(), list);
      }
      const Eigen::Vector2d found = distort(lens.distortion, p).xy;
      EXPECT_LT((found - Eigen::Vector2d(expected[0].x, expected[0].y)).norm(), 1e-12) << p.transpose();
    }
  }
}

// θ_d of the formula, at 120 degrees off axis.
TEST(Distort, OfAFisheyeGoesOnBeyond90Degrees) {
  const double theta = 2.0 * std::numbers::pi / 3.0, s = theta * theta;
  const Eigen::Vector3d p = 3.0 * Eigen::Vector3d(0.6 * std::sin(theta), 0.8 * std::sin(theta), std::cos(theta));
  const double radius = theta * (1 + s * (0.0035 + s * (0.0007 + s * (-0.002 + s * 0.0002))));
  EXPECT_LT((distort(kLenses.back().distortion, p).xy - radius * Eigen::Vector2d(0.6, 0.8)).norm(), 1e-12);
}

TEST(Distort, HasTheJacobianOfCentralDifferences) {
  for (const Lens& lens : kLenses) {
    for (const Eigen::Vector3d& p : points_in_view(lens)) {
      const double h = 1e-6 * p.norm();
      Eigen::Matrix<double, 2, 3> J;
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
        J.col(i) = (distort(lens.distortion, p + step).xy - distort(lens.distortion, p - step).xy) / (2 * h);
      }
      EXPECT_LT((distort(lens.distortion, p).J_xy_point - J).norm(), 1e-7 * J.norm()) << p.transpose();
    }
  }
}

TEST(Distort, OnTheAxisIsAPinhole) {
  Eigen::Matrix<double, 2, 3> J = Eigen::Matrix<double, 2, 3>::Zero();
  J(0, 0) = J(1, 1) = 0.5;
  for (const Lens& lens : kLenses) {
    const DistortedPoint found = distort(lens.distortion, {0, 0, 2});
    EXPECT_EQ(found.xy, Eigen::Vector2d::Zero());
    EXPECT_LT((found.J_xy_point - J).norm(), 1e-12);
    EXPECT_EQ(coefficient_jacobian(lens.distortion, {0, 0, 2}).norm(), 0);
  }
}

TEST(CoefficientJacobian, IsThatOfCentralDifferences) {
  for (const Lens& lens : kLenses) {
    const DistortionCoefficients k = coefficients(lens.distortion);
    for (const Eigen::Vector3d& p : points_in_view(lens)) {
      const auto found = coefficient_jacobian(lens.distortion, p);
      ASSERT_EQ(found.cols(), k.size());
      for (Eigen::Index i = 0; i < k.size(); ++i) {
        constexpr double h = 1e-5;
        const auto nudged = [&](double by) {
          DistortionCoefficients values = k;
          values[i] += by;
          return distort(with_coefficients(lens.distortion, {values.data(), static_cast<std::size_t>(k.size())}), p).xy;
        };
        const Eigen::Vector2d expected = (nudged(h) - nudged(-h)) / (2 * h);
        EXPECT_LT((found.col(i) - expected).norm(), 1e-7 * (1 + expected.norm())) << i << ": " << p.transpose();
      }
    }
  }
}

TEST(UndistortedDirection, GivesBackTheDirection) {
  for (const Lens& lens : kLenses) {
    for (const Eigen::Vector3d& p : points_in_view(lens)) {
      ASSERT_FALSE(folds_back(lens.distortion, p)) << p.transpose();
      const auto direction = undistorted_direction(lens.distortion, distort(lens.distortion, p).xy);
      ASSERT_TRUE(direction) << p.transpose();
      EXPECT_LT((*direction - p.normalized()).norm(), 1e-9) << p.transpose();
    }
  }
}

// θ (1 + 0.3 θ² - 0.1 θ⁴) grows faster than θ until it folds at 1.605, where it is 1.78: an angle of 1.7 has the radius
// of none.
TEST(UndistortedDirection, IsFoundWhereTheRadiusExceedsTheAngleOfTheFold) {
  const Fisheye lens{0.3, -0.1, 0, 0};
  for (double theta = 0.05; theta < 1.59; theta += 0.05) {
    const Eigen::Vector3d p(std::sin(theta), 0, std::cos(theta));
    ASSERT_FALSE(folds_back(lens, p)) << theta;
    const auto direction = undistorted_direction(lens, distort(lens, p).xy);
    ASSERT_TRUE(direction) << theta;
    EXPECT_LT((*direction - p).norm(), 1e-7) << theta;
  }
}

// θ (1 - 0.1 θ²) is at most 1.217, at θ² = 1/0.3; θ itself ends at the backward axis.
TEST(UndistortedDirection, IsEmptyBeyondTheLargestRadius) {
  EXPECT_TRUE(undistorted_direction(Fisheye{-0.1, 0, 0, 0}, {1.216, 0}));
  EXPECT_FALSE(undistorted_direction(Fisheye{-0.1, 0, 0, 0}, {1.218, 0}));
  EXPECT_TRUE(undistorted_direction(Fisheye{}, {0, 3.14}));
  EXPECT_FALSE(undistorted_direction(Fisheye{}, {0, 3.15}));
  // r / (1 + r²/2) is at most 1/√2, at r = √2.
  const BrownConrady rational{0, 0, 0, 0, 0, 0.5, 0, 0};
  EXPECT_TRUE(undistorted_direction(rational, {0.7, 0}));
  EXPECT_FALSE(undistorted_direction(rational, {0.71, 0}));
}

TEST(FoldsBack, FromTheAngleAtWhichTheRadiusStopsGrowing) {
  const auto at_angle = [](double theta) { return Eigen::Vector3d(std::sin(theta), 0, std::cos(theta)); };
  const double fold = std::sqrt(1.0 / 0.3);  // of θ (1 - 0.1 θ²): beyond 90 degrees
  EXPECT_FALSE(folds_back(Fisheye{-0.1, 0, 0, 0}, at_angle(0.999 * fold)));
  EXPECT_TRUE(folds_back(Fisheye{-0.1, 0, 0, 0}, at_angle(1.001 * fold)));
  EXPECT_TRUE(folds_back(Fisheye{-0.1, 0, 0, 0}, at_angle(3.0)));
  EXPECT_FALSE(folds_back(Fisheye{}, at_angle(3.0)));
  const BrownConrady rational{0, 0, 0, 0, 0, 0.5, 0, 0};  // r / (1 + r²/2) grows until r = √2
  EXPECT_FALSE(folds_back(rational, {1.414, 0, 1}));
  EXPECT_TRUE(folds_back(rational, {1.415, 0, 1}));
  EXPECT_TRUE(folds_back(rational, {0, 20, 1}));
}

// 1 - r² is 0 at r = 1: the image of the pole lies at infinity, and what comes behind it is none.
TEST(FoldsBack, BehindAPoleOfTheQuotient) {
  const BrownConrady lens{0, 0, 0, 0, 0, -1.0, 0, 0};
  EXPECT_FALSE(folds_back(lens, {0.9, 0, 1}));
  EXPECT_TRUE(folds_back(lens, {1.1, 0, 1}));
}

TEST(Coefficients, BearTheNamesOfTheirOrder) {
  const auto names = [](const Distortion& distortion) {
    std::string joined;
    for (const std::string_view name : coefficient_names(distortion)) joined += std::string(name) + " ";
    return joined;
  };
  EXPECT_EQ(names(BrownConrady{}), "k1 k2 p1 p2 k3 k4 k5 k6 ");
  EXPECT_EQ(names(Fisheye{}), "k1 k2 k3 k4 ");
  const BrownConrady lens{.k1 = 1, .k2 = 2, .p1 = 3, .p2 = 4, .k3 = 5, .k4 = 6, .k5 = 7, .k6 = 8};
  const DistortionCoefficients values = coefficients(lens);
  ASSERT_EQ(values.size(), 8);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(values[i], i + 1);
}

TEST(WithCoefficients, IsTheInverseOfCoefficients) {
  for (const Lens& lens : kLenses) {
    const DistortionCoefficients k = coefficients(lens.distortion);
    EXPECT_EQ(with_coefficients(lens.distortion, {k.data(), static_cast<std::size_t>(k.size())}), lens.distortion);
  }
}

TEST(WithCoefficients, LeavesTheOthersZeroAndRefusesTooMany) {
  const std::vector<double> four{0.1, 0.2, 0.3, 0.4}, five{0.1, 0.2, 0.3, 0.4, 0.5}, nine(9, 0.0);
  EXPECT_EQ(with_coefficients(BrownConrady{9, 9, 9, 9, 9, 9, 9, 9}, four),
            Distortion(BrownConrady{0.1, 0.2, 0.3, 0.4, 0, 0, 0, 0}));
  EXPECT_EQ(with_coefficients(Fisheye{}, four), Distortion(Fisheye{0.1, 0.2, 0.3, 0.4}));
  EXPECT_THROW(with_coefficients(Fisheye{}, five), std::invalid_argument);
  EXPECT_THROW(with_coefficients(BrownConrady{}, nine), std::invalid_argument);
}

TEST(IsPinhole, OnlyOfBrownAndConradysZero) {
  EXPECT_TRUE(is_pinhole(BrownConrady{}));
  EXPECT_FALSE(is_pinhole(BrownConrady{0, 0, 0, 0, 0, 0, 0, 1e-9}));
  EXPECT_FALSE(is_pinhole(Fisheye{}));
}

}  // namespace
}  // namespace alidade
