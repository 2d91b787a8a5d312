// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "core/errors.h"
#include "io/trajectory_file.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

Matrix6d some_covariance() {
  Matrix6d A;
  for (int i = 0; i < 36; ++i) A(i / 6, i % 6) = 1.0 / (1.0 + i * i % 7) - 0.3 * (i % 5);
  return A * A.transpose();
}

Trajectory some_trajectory() {
  Trajectory trajectory(3);
  for (std::size_t i = 0; i < 3; ++i) trajectory[i].time = Timestamp(i * 33333333ns);
  trajectory[0].covariance = some_covariance();
  trajectory[2].covariance = 1e-9 * some_covariance();
  return trajectory;
}

std::string fault_of(const std::string& text) {
  const test::TemporaryDirectory folder;
  try {
    read_covariances(folder.write("covariance.csv", text), some_trajectory());
  } catch (const InputError& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
  return "no fault";
}

TEST(CovarianceFile, IsReadBackExactlyAndJoinedByTime) {
  const test::TemporaryDirectory folder;
  const Trajectory written = some_trajectory();
  write_covariances(folder / "covariance.csv", written);
  Trajectory bare = written;
  for (StampedPose& pose : bare) pose.covariance.reset();
  const Trajectory read = read_covariances(folder / "covariance.csv", bare);
  EXPECT_EQ(*read[0].covariance, *written[0].covariance);
  EXPECT_FALSE(read[1].covariance);
  EXPECT_EQ(*read[2].covariance, *written[2].covariance);
}

TEST(CovarianceFile, StatesFrameOrderAndUnits) {
  const test::TemporaryDirectory folder;
  write_covariances(folder / "covariance.csv", {});
  std::ifstream file(folder / "covariance.csv");
  std::string comment, columns;
  std::getline(file, comment);
  std::getline(file, columns);
  EXPECT_NE(comment.find("xi = (translation, rotation vector) on the right of T_world_camera"), std::string::npos);
  EXPECT_EQ(
      columns,
      "t_ns,x_x_m2,x_y_m2,x_z_m2,x_rx_m_rad,x_ry_m_rad,x_rz_m_rad,y_y_m2,y_z_m2,y_rx_m_rad,y_ry_m_rad,y_rz_m_rad,"
      "z_z_m2,z_rx_m_rad,z_ry_m_rad,z_rz_m_rad,rx_rx_rad2,rx_ry_rad2,rx_rz_rad2,ry_ry_rad2,ry_rz_rad2,rz_rz_rad2");
}

TEST(CovarianceFile, StandsBesideItsTrajectory) {
  EXPECT_EQ(covariance_path("out/trajectory.tum"), "out/covariance.csv");
  EXPECT_EQ(covariance_path("out/left.tum"), "out/left.covariance.csv");
}

TEST(CovarianceFile, NamesLineAndFault) {
  std::string zeros;
  for (int i = 0; i < 21; ++i) zeros += ",0";
  const std::string header = "t_ns" + zeros + "\n";
  const std::string again = "; write the file again with 'alidade track camera'";
  EXPECT_EQ(fault_of(header + "0" + zeros + "\n"), "no fault");
  EXPECT_EQ(fault_of(""), "covariance.csv: has no header line with t_ns and 21 entries" + again);
  EXPECT_EQ(fault_of("0" + zeros + "\n"), "covariance.csv:1: has no header line with t_ns and 21 entries" + again);
  EXPECT_EQ(fault_of(header + "0,1,2\n"), "covariance.csv:2: has 3 columns, must have 22" + again);
  EXPECT_EQ(fault_of(header + "0.5" + zeros + "\n").substr(0, 17), "covariance.csv:2:");
  EXPECT_EQ(fault_of(header + "7" + zeros + "\n"),
            "covariance.csv:2: the trajectory has no pose at 0.000000007 s; keep the covariances beside the trajectory "
            "they belong to");
  EXPECT_EQ(fault_of(header + "0,-1" + zeros.substr(2) + "\n"),
            "covariance.csv:2: the covariance is not positive semi-definite" + again);
}

}  // namespace
}  // namespace alidade
