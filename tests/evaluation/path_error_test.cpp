// SPDX-License-Identifier: Apache-2.0
#include "evaluation/path_error.h"

#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/evaluation/paths.h"

namespace alidade {
namespace {

constexpr double kPi = std::numbers::pi;

Eigen::Matrix3d from_angles(double roll, double pitch, double yaw) {
  return exp_so3({0, 0, yaw}) * exp_so3({0, pitch, 0}) * exp_so3({roll, 0, 0});
}

TEST(RollPitchYaw, ComeBackFromTheRotation) {
  for (double roll : {-3.0, -0.5, 0.0, 1.0, 3.1}) {
    for (double pitch : {-1.57, -0.3, 0.0, 1.5}) {
      for (double yaw : {-3.1, 0.0, 2.0}) {
        EXPECT_LT((roll_pitch_yaw(from_angles(roll, pitch, yaw)) - Eigen::Vector3d(roll, pitch, yaw)).norm(), 1e-10)
            << roll << ' ' << pitch << ' ' << yaw;
      }
    }
  }
}

TEST(RollPitchYaw, PutAllIntoYawAtTheLock) {
  Eigen::Matrix3d R;
  R << 0, 0, 1, 0, 1, 0, -1, 0, 0;  // pitch exactly 90 degrees
  EXPECT_LT((roll_pitch_yaw(R) - Eigen::Vector3d(0, kPi / 2, 0)).norm(), 1e-12);
}

// A path of 1 + 2 + 1 = 4 m; an error of 0.2 m is 5 % of it.
TEST(PathErrors, AreInPercentOfTheTruePath) {
  Trajectory truth;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), {1, 0, 0}, {1, 2, 0}, {1, 2, 1}}) {
    truth.push_back(test::pose_at_time(static_cast<double>(truth.size()), p));
  }
  Trajectory estimate = truth;
  estimate[2].T_world_camera.translation().x() += 0.2;
  const PathErrors errors = path_errors({estimate, truth});
  EXPECT_DOUBLE_EQ(errors.path_length_m, 4.0);
  EXPECT_NEAR(errors.translation_percent.values[2], 5.0, 1e-12);
  EXPECT_EQ(errors.translation_percent.values[1], 0.0);
}

TEST(PathErrors, TakeAngleDifferencesTheShortWayRound) {
  Trajectory truth(1), estimate(1);
  truth[0].T_world_camera.linear() = from_angles(kPi - 0.01, 0.2, -kPi + 0.02);
  estimate[0].T_world_camera.linear() = from_angles(-kPi + 0.02, 0.2, kPi - 0.02);
  const PathErrors errors = path_errors({estimate, truth});
  EXPECT_NEAR(errors.rotation_deg.values[0], std::hypot(0.03, 0.04) * 180 / kPi, 1e-9);
  EXPECT_EQ(errors.translation_percent.values[0], 0.0);  // no path, no percentage
}

TEST(PathErrors, RefuseUnequalLengths) {
  EXPECT_THROW(path_errors({test::winding_path(2), test::winding_path(3)}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
