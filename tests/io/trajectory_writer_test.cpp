// SPDX-License-Identifier: Apache-2.0
#include "io/trajectory_writer.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "geometry/rotation.h"
#include "io/text_lines.h"
#include "io/trajectory_file.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

Trajectory some_poses(int count) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    StampedPose pose;
    pose.time = Timestamp(1305031229528748001ns + i * 4ms);
    pose.T_world_camera.translation() = Eigen::Vector3d(i / 3.0, -1e-7 * i, 12345.678);
    pose.T_world_camera.linear() = exp_so3({0.1 * i, -2.0, 1.5});
    if (i % 3 != 1) pose.covariance = (1e-6 / (i + 1)) * Matrix6d::Identity();
    trajectory.push_back(pose);
  }
  return trajectory;
}

TEST(TrajectoryWriter, LeavesWhatTheWholeTrajectoryWouldHaveLeft) {
  const test::TemporaryDirectory folder;
  const Trajectory poses = some_poses(7);
  TrajectoryWriter writer(folder / "streamed.tum");
  for (const StampedPose& pose : poses) writer.write(pose);
  writer.commit();
  write_trajectory_tum(folder / "whole.tum", poses);
  write_covariances(folder / "whole.covariance.csv", poses);
  EXPECT_EQ(read_bytes(folder / "streamed.tum"), read_bytes(folder / "whole.tum"));
  EXPECT_EQ(read_bytes(folder / "streamed.covariance.csv"), read_bytes(folder / "whole.covariance.csv"));
}

TEST(TrajectoryWriter, IsReadBackWithCovariances) {
  const test::TemporaryDirectory folder;
  const Trajectory poses = some_poses(4);
  TrajectoryWriter writer(folder / "trajectory.tum", "body");
  for (const StampedPose& pose : poses) writer.write(pose);
  writer.commit();
  const Trajectory read = read_covariances(folder / "covariance.csv", read_trajectory(folder / "trajectory.tum").poses);
  ASSERT_EQ(read.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(read[i].time, poses[i].time);
    EXPECT_EQ(read[i].T_world_camera.translation(), poses[i].T_world_camera.translation());
    EXPECT_EQ(read[i].covariance, poses[i].covariance);
  }
}

TEST(TrajectoryWriter, NamesWhosePosesTheyAre) {
  const test::TemporaryDirectory folder;
  TrajectoryWriter writer(folder / "trajectory.tum", "body");
  writer.write(some_poses(1)[0]);
  writer.commit();
  EXPECT_TRUE(
      read_bytes(folder / "trajectory.tum").starts_with("# timestamp[s] tx ty tz[m] qx qy qz qw: body to world\n"));
  EXPECT_TRUE(read_bytes(folder / "covariance.csv")
                  .starts_with("# covariance of xi = (translation, rotation vector) on the right of T_world_body, in "
                               "body axes; upper triangle; m^2, m rad, rad^2\nt_ns,x_x_m2,"));
}

TEST(TrajectoryWriter, LeavesNothingWithoutCommit) {
  const test::TemporaryDirectory folder;
  {
    TrajectoryWriter writer(folder / "trajectory.tum");
    writer.write(some_poses(1)[0]);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(TrajectoryWriter, SaysWhereItCannotWrite) {
  const test::TemporaryDirectory folder;
  EXPECT_THROW(TrajectoryWriter(folder / "missing/a.tum"), DeviceError);
}

}  // namespace
}  // namespace alidade
