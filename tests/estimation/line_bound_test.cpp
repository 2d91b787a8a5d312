// SPDX-License-Identifier: Apache-2.0
#include "estimation/line_bound.h"

#include <gtest/gtest.h>

#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 83;

// Detectors of one focal line each, `distance_m` from the origin and looking at it, on all sides.
std::vector<LineDetector> detectors_about(int count, double distance_m, test::RandomGeometry& random) {
  std::vector<LineDetector> detectors;
  for (int i = 0; i < count; ++i) {
    const Eigen::Matrix3d R =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), random.direction()).toRotationMatrix();
    LineDetector detector;
    detector.id = i;
    detector.sigma = 1e-4 * (1 + i % 3);
    detector.T_world_station.linear() = R * exp_so3({0, 0, random.uniform(0, 3)});
    detector.T_world_station.translation() = -distance_m * R.col(2);
    detectors.push_back(detector);
  }
  return detectors;
}

RigidBody tetrahedron() {
  return {"body", {{0, {0.1, 0.1, 0.1}}, {1, {0.1, -0.1, -0.1}}, {2, {-0.1, 0.1, -0.1}}, {3, {-0.1, -0.1, 0.1}}}};
}

std::vector<LineReading> one_reading_each(std::span<const LineDetector> detectors, const RigidBody& body) {
  std::vector<LineReading> readings;
  for (const LineDetector& detector : detectors) {
    for (const BodyMarker& marker : body.markers) readings.push_back({{}, detector.id, marker.id, 0.0, 0.0});
  }
  return readings;
}

class LineBound : public testing::Test {
 protected:
  test::RandomGeometry random_{kSeed};
  std::vector<LineDetector> detectors_ = detectors_about(10, 2.0, random_);
  RigidBody body_ = tetrahedron();
  Eigen::Isometry3d T_ = random_.pose(0.2);
  std::vector<LineReading> readings_ = one_reading_each(detectors_, body_);
};

TEST_F(LineBound, JacobianIsTheDerivativeOfTheReading) {
  for (const LineDetector& detector : detectors_) {
    const Eigen::Vector3d p_body = body_.markers[1].p_body;
    const auto J = reading_jacobian(detector, T_, p_body);
    ASSERT_TRUE(J);
    for (int i = 0; i < 6; ++i) {
      const Vector6d step = 1e-5 * Vector6d::Unit(i);
      const double expected = (project(detector, T_ * perturbation(step) * p_body)->value -
                               project(detector, T_ * perturbation(-step) * p_body)->value) /
                              2e-5;
      EXPECT_NEAR((*J)(i), expected, 1e-9) << "column " << i << ", seed " << kSeed;
    }
  }
}

TEST_F(LineBound, InformationIsTheSumOverReadings) {
  const Matrix6d whole = pose_information(detectors_, body_, T_, readings_);
  Matrix6d parts = Matrix6d::Zero();
  for (const LineReading& r : readings_) parts += pose_information(detectors_, body_, T_, {&r, 1});
  EXPECT_LT((whole - parts).norm(), 1e-12 * whole.norm());
  readings_[0].sigma = 1e-3;
  EXPECT_LT(pose_information(detectors_, body_, T_, readings_).trace(), whole.trace());
}

// Maximum likelihood from exact derivatives reaches the bound where errors are small.
TEST_F(LineBound, IsWhatTheBestLinearEstimateReaches) {
  const Matrix6d information = pose_information(detectors_, body_, T_, readings_);
  const auto bound = pose_bound(information);
  ASSERT_TRUE(bound);
  double position_m2 = 0, rotation_rad2 = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    Vector6d gradient = Vector6d::Zero();
    for (const LineReading& r : readings_) {
      const auto& detector = detectors_[static_cast<std::size_t>(r.detector)];
      const auto J = reading_jacobian(detector, T_, body_.markers[static_cast<std::size_t>(r.marker)].p_body);
      gradient += J->transpose() * random_.normal(1.0) / detector.sigma;
    }
    const Vector6d error = information.ldlt().solve(gradient);
    position_m2 += error.head<3>().squaredNorm() / kTrials;
    rotation_rad2 += error.tail<3>().squaredNorm() / kTrials;
  }
  EXPECT_NEAR(position_m2 / bound->position_m2, 1.0, 0.1) << "seed " << kSeed;
  EXPECT_NEAR(rotation_rad2 / bound->rotation_rad2, 1.0, 0.1) << "seed " << kSeed;
}

TEST_F(LineBound, IsEmptyWhereThePoseIsNotDetermined) {
  std::erase_if(readings_, [](const LineReading& r) { return r.marker >= 2; });  // free to turn about two markers
  EXPECT_FALSE(pose_bound(pose_information(detectors_, body_, T_, readings_)));
  EXPECT_FALSE(pose_bound(Matrix6d::Zero()));
}

TEST_F(LineBound, LeavesOutOtherBodiesAndRefusesUnknownDetectors) {
  const Matrix6d information = pose_information(detectors_, body_, T_, readings_);
  readings_.push_back({{}, 0, 17, 0.0, 0.0});
  EXPECT_EQ(pose_information(detectors_, body_, T_, readings_), information);
  readings_.push_back({{}, 10, 0, 0.0, 0.0});
  EXPECT_THROW(pose_information(detectors_, body_, T_, readings_), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
