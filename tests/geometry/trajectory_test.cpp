// SPDX-License-Identifier: Apache-2.0
#include "geometry/trajectory.h"

#include <gtest/gtest.h>

#include "geometry/rotation.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

StampedPose at(RecordingClock::duration time, const Eigen::Vector3d& centre, double yaw_rad = 0) {
  StampedPose pose;
  pose.time = Timestamp(time);
  pose.T_world_camera.linear() = exp_so3({0, 0, yaw_rad});
  pose.T_world_camera.translation() = centre;
  return pose;
}

const Trajectory kPath{at(1s, {0, 0, 0}, 0.0), at(2s, {3, 0, 0}, 0.2), at(4s, {3, 4, 0}, 0.2)};

TEST(PathLength, IsTheSumOfTheSteps) {
  EXPECT_DOUBLE_EQ(path_length(kPath), 7.0);
  EXPECT_EQ(path_length({}), 0.0);
  EXPECT_EQ(path_length({kPath[0]}), 0.0);
}

TEST(TwistAt, IsTheVelocityOfASteadyMotionAlongTheCamerasAxes) {
  Vector6d twist;
  twist << 0.4, -0.2, 0.1, 0.3, 1.1, -0.7;
  const auto longest_gap = std::chrono::seconds(1);
  Trajectory trajectory;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 40; ++i) {  // small steps: perturbation() is no screw
    trajectory.push_back({Timestamp(std::chrono::milliseconds(i)), T, {}});
    T = T * perturbation(0.001 * twist);
  }
  const auto found =
      twist_at(trajectory, Timestamp(std::chrono::milliseconds(20)), std::chrono::milliseconds(5), longest_gap);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - twist).norm(), 1e-3);
  EXPECT_FALSE(
      twist_at(trajectory, Timestamp(std::chrono::milliseconds(2)), std::chrono::milliseconds(5), longest_gap));
}

TEST(PoseAt, IsTheStoredPoseAtItsTime) {
  for (const StampedPose& pose : kPath) {
    const auto found = pose_at(kPath, pose.time, 0ns);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->matrix(), pose.T_world_camera.matrix());
  }
}

TEST(PoseAt, InterpolatesBetweenNeighbours) {
  const auto found = pose_at(kPath, Timestamp(1500ms), 1s);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->translation().isApprox(Eigen::Vector3d(1.5, 0, 0), 1e-12));
  EXPECT_TRUE(found->linear().isApprox(exp_so3({0, 0, 0.1}), 1e-12));
}

TEST(PoseAt, IsEmptyOutsideAndInALongGap) {
  EXPECT_FALSE(pose_at(kPath, Timestamp(999ms), 10s));
  EXPECT_FALSE(pose_at(kPath, Timestamp(4001ms), 10s));
  EXPECT_FALSE(pose_at(kPath, Timestamp(3s), 1999ms));
  EXPECT_TRUE(pose_at(kPath, Timestamp(3s), 2s));
  EXPECT_FALSE(pose_at({}, Timestamp(0s), 10s));
}

}  // namespace
}  // namespace alidade
