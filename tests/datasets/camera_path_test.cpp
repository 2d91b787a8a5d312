// SPDX-License-Identifier: Apache-2.0
#include "datasets/camera_path.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "datasets/furnished_room.h"
#include "geometry/pose.h"

namespace alidade {
namespace {

class EveryPath : public testing::TestWithParam<PathKind> {};

Vector6d velocity(PathKind kind, double t) {
  constexpr double h = 1e-4;
  return difference(camera_on_path(kind, 0.4, t), camera_on_path(kind, 0.4, t + h)) / h;
}

TEST_P(EveryPath, IsSmooth) {
  for (double t = -1; t < 30; t += 0.037) {
    const Vector6d jump = velocity(GetParam(), t + 0.002) - velocity(GetParam(), t);
    EXPECT_LT(jump.norm(), 0.02) << t;  // an acceleration of 10 (m/s², rad/s²) would give that
  }
}

TEST_P(EveryPath, StaysInTheRoomAndOutOfTheTable) {
  for (double t = 0; t < 60; t += 0.1) {
    const Eigen::Vector3d p = camera_on_path(GetParam(), 0.4, t).translation();
    EXPECT_LT(std::abs(p.x()), 2.4) << t;
    EXPECT_LT(std::abs(p.y()), 2.0) << t;
    EXPECT_GT(p.z(), 1.1) << t;
    EXPECT_LT(p.z(), 2.0) << t;
    EXPECT_TRUE(std::abs(p.x()) > kTableHalfWidth_m || std::abs(p.y()) > kTableHalfDepth_m) << t;
  }
}

TEST_P(EveryPath, IsUprightAndARotation) {
  for (double t = 0; t < 30; t += 0.5) {
    const Eigen::Matrix3d R = camera_on_path(GetParam(), 0.4, t).linear();
    EXPECT_TRUE((R.transpose() * R).isIdentity(1e-9));
    EXPECT_LT(R(2, 1), -0.6) << t;  // y points down
  }
}

INSTANTIATE_TEST_SUITE_P(CameraPath, EveryPath,
                         testing::Values(PathKind::Orbit, PathKind::Sweep, PathKind::Rotation, PathKind::StopAndGo));

TEST(CameraPath, OrbitAndSweepMoveInAllSixDegreesOfFreedom) {
  for (const PathKind kind : {PathKind::Orbit, PathKind::Sweep}) {
    Vector6d squares = Vector6d::Zero();
    for (int i = 0; i < 300; ++i) squares += velocity(kind, i / 30.0).cwiseAbs2() / 300;
    EXPECT_GT(squares.cwiseSqrt().minCoeff(), 0.02) << squares.cwiseSqrt().transpose();  // m/s and rad/s
  }
}

TEST(CameraPath, RotationHasNoParallaxWhatever) {
  const Eigen::Vector3d centre = camera_on_path(PathKind::Rotation, 0.4, 0).translation();
  double turned = 0;
  for (double t = 0; t < 10; t += 0.1) {
    const Eigen::Isometry3d T = camera_on_path(PathKind::Rotation, 0.4, t);
    EXPECT_EQ(T.translation(), centre);
    turned =
        std::max(turned, rotation_angle(camera_on_path(PathKind::Rotation, 0.4, 0).linear().transpose() * T.linear()));
  }
  EXPECT_GT(turned, 0.5);
}

TEST(CameraPath, StopAndGoRests) {
  EXPECT_LT(velocity(PathKind::StopAndGo, 1.8).norm(), 1e-9);
  EXPECT_GT(velocity(PathKind::StopAndGo, 0.7).head<3>().norm(), 0.4);
  EXPECT_GT((camera_on_path(PathKind::StopAndGo, 0.4, 11).translation() -
             camera_on_path(PathKind::StopAndGo, 0.4, 0).translation())
                .norm(),
            1.0);
}

TEST(CameraPath, GoesAtTheSpeedAskedFor) {
  double walked = 0;
  for (int i = 0; i < 300; ++i) {
    walked += velocity(PathKind::Orbit, i / 30.0).head<3>().norm() / 30;
  }
  EXPECT_NEAR(walked / 10, 0.4, 0.06);
}

}  // namespace
}  // namespace alidade
