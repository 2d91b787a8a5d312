// SPDX-License-Identifier: Apache-2.0
#include "io/position_file.h"

#include <gtest/gtest.h>

#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

class PositionFile : public testing::Test {
 protected:
  std::string message(const std::string& text) {
    return test::message_of(folder_.path(), [&] { read_positions(folder_.write("truth.csv", text)); });
  }
  test::TemporaryDirectory folder_;
};

TEST_F(PositionFile, ReadsSecondsAndNanosecondsAmongOtherColumns) {
  const auto by_s = read_positions(folder_.write("a.csv", "t_s,x_m,y_m,z_m,method\n0.1,1,2,3,beam\n0.2,4,5,6,beam\n"));
  ASSERT_EQ(by_s.size(), 2u);
  EXPECT_EQ(by_s[0].time, Timestamp(100ms));
  EXPECT_EQ(by_s[1].p, Eigen::Vector3d(4, 5, 6));
  const auto by_ns = read_positions(folder_.write("b.csv", "z_m,t_ns,x_m,y_m\n3,7,1,2\n"));
  EXPECT_EQ(by_ns[0].time, Timestamp(7ns));
  EXPECT_EQ(by_ns[0].p, Eigen::Vector3d(1, 2, 3));
}

TEST_F(PositionFile, TakesThePositionsOfATrajectory) {
  const auto positions = read_positions(folder_.write("truth.tum", "# t x y z q\n1.5 1 2 3 0 0 0 1\n"));
  ASSERT_EQ(positions.size(), 1u);
  EXPECT_EQ(positions[0].time, Timestamp(1500ms));
  EXPECT_EQ(positions[0].p, Eigen::Vector3d(1, 2, 3));
}

TEST_F(PositionFile, NamesTheLineOfWhatIsWrong) {
  EXPECT_EQ(message("t_s,x_m,y_m,z_m\n1,0,0,0\n0.5,0,0,0\n"),
            "truth.csv:3: time goes back; sort the positions by time");
  EXPECT_EQ(message("t_s,x_m,y_m,z_m\n1,0,nan,0\n").substr(0, 28), "truth.csv:2: column 'y_m': '");
  EXPECT_EQ(message("t_s,x_m,y_m,z_m\n").substr(0, 28), "truth.csv: holds no position");
  EXPECT_NE(message("t_s,x_m,y_m\n1,0,0\n").find("z_m"), std::string::npos);
  EXPECT_EQ(message("t_s,x_m,y_m,z_m\nsoon,0,0,0\n").substr(0, 28), "truth.csv:2: column 't_s': '");
}

}  // namespace
}  // namespace alidade
