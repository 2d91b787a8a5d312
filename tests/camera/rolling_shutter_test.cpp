// SPDX-License-Identifier: Apache-2.0
#include "camera/rolling_shutter.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

Camera rolling_camera() {
  Camera camera{640, 480, 520, 515, 320, 240, BrownConrady{0.2, -0.5, 0.001, -0.002, 0}};
  camera.readout_s = 0.02;
  return camera;
}

Vector6d moving() {
  Vector6d twist;
  twist << 0.5, -0.3, 0.4, 1.2, -0.8, 2.0;
  return twist;
}

// What a rolling shutter shows of a point: the row decides when the point is seen, and the moment decides the row.
Eigen::Vector2d see(const Camera& camera, const Vector6d& twist, const Eigen::Vector3d& p_middle) {
  Eigen::Vector2d pixel = project(camera, p_middle)->pixel;
  for (int i = 0; i < 50; ++i) {
    pixel = project(camera, perturbation(row_time_s(camera, pixel.y()) * twist).inverse() * p_middle)->pixel;
  }
  return pixel;
}

TEST(RollingShutter, ExposesTheMiddleRowAtTheTimeOfTheImage) {
  const Camera camera = rolling_camera();
  EXPECT_DOUBLE_EQ(row_time_s(camera, 239.5), 0.0);
  EXPECT_DOUBLE_EQ(row_time_s(camera, -0.5), -0.01);
  EXPECT_DOUBLE_EQ(row_time_s(camera, 479.5), 0.01);
}

TEST(RollingShutter, IsTakenOutExactlyWhereTheDepthIsKnown) {
  const Camera camera = rolling_camera();
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0.6, 0.5, 1.5), Eigen::Vector3d(-0.5, -0.6, 2.0)}) {
    const Eigen::Vector2d seen = see(camera, moving(), p);
    const Eigen::Vector2d middle = project(camera, p)->pixel;
    const Eigen::Vector3d p_row = perturbation(row_time_s(camera, seen.y()) * moving()).inverse() * p;
    EXPECT_GT((seen - middle).norm(), 3.0);
    EXPECT_LT((at_middle_row(camera, seen, moving(), p_row.z()) - middle).norm(), 1e-6);
  }
}

TEST(RollingShutter, OfATurningCameraNeedsNoDepth) {
  const Camera camera = rolling_camera();
  Vector6d turning = moving();
  turning.head<3>().setZero();
  const Eigen::Vector3d p(0.4, -0.5, 1.3);
  EXPECT_LT((at_middle_row(camera, see(camera, turning, p), turning) - project(camera, p)->pixel).norm(), 1e-6);
}

TEST(RollingShutter, OfZeroReadoutMovesNothing) {
  Camera camera = rolling_camera();
  camera.readout_s = 0;
  EXPECT_EQ(at_middle_row(camera, {12, 400}, moving(), 1.0), Eigen::Vector2d(12, 400));
}

}  // namespace
}  // namespace alidade
