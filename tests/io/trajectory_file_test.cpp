// SPDX-License-Identifier: Apache-2.0
#include "io/trajectory_file.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "core/errors.h"
#include "geometry/rotation.h"
#include "tests/support/data_directory.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

// The message of the fault without the folder of the test, or "no fault".
std::string fault_of(const test::TemporaryDirectory& folder, const std::filesystem::path& path) {
  try {
    read_trajectory(path);
  } catch (const InputError& error) {
    std::string what = error.what();
    const std::string prefix = folder.path().string() + "/";
    for (std::size_t at = what.find(prefix); at != std::string::npos; at = what.find(prefix))
      what.erase(at, prefix.size());
    return what;
  }
  return "no fault";
}

std::string fault_of_text(const std::string& text) {
  const test::TemporaryDirectory folder;
  return fault_of(folder, folder.write("a.txt", text));
}

// A quarter turn about z: camera x points along world y.
const Eigen::Matrix3d kQuarterTurn = (Eigen::Matrix3d() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished();

// Of the quaternion with vector (0, 0, 0.6) and scalar 0.8: a turn about z by 2 atan(0.6 / 0.8).
const Eigen::Matrix3d kTurn = exp_so3({0, 0, 2.0 * std::atan2(0.6, 0.8)});

TEST(ReadTrajectory, ReadsTum) {
  const test::TemporaryDirectory folder;
  const TrajectoryFile file = read_trajectory(folder.write("a.txt",
                                                           "# timestamp tx ty tz qx qy qz qw\r\n"
                                                           "1305031229.528748 1 2 3 0 0 0.6 0.8\r\n\r\n"
                                                           "1305031229.564425\t-1e-3 +2 3  0 0 0 1\r\n"));
  EXPECT_EQ(file.format, TrajectoryFormat::Tum);
  EXPECT_TRUE(file.has_times);
  ASSERT_EQ(file.poses.size(), 2u);
  EXPECT_EQ(file.poses[0].time, Timestamp(1305031229528748000ns));
  EXPECT_EQ(file.poses[0].T_world_camera.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(file.poses[0].T_world_camera.linear().isApprox(kTurn, 1e-12));
  EXPECT_EQ(file.poses[1].T_world_camera.translation(), Eigen::Vector3d(-1e-3, 2, 3));
}

TEST(ReadTrajectory, CountsThePosesOfKitti) {
  const test::TemporaryDirectory folder;
  const TrajectoryFile file =
      read_trajectory(folder.write("00.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 1 1 0 0 2 0 0 1 3\n"));
  EXPECT_EQ(file.format, TrajectoryFormat::Kitti);
  EXPECT_FALSE(file.has_times);
  EXPECT_EQ(file.poses.at(1).time, Timestamp(1s));
  EXPECT_EQ(file.poses[1].T_world_camera.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(file.poses[1].T_world_camera.linear().isApprox(kQuarterTurn, 1e-12));
}

TEST(ReadTrajectory, ReadsEurocWithTheScalarOfTheQuaternionFirst) {
  const test::TemporaryDirectory folder;
  const TrajectoryFile file = read_trajectory(folder.write(
      "data.csv",
      "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], v\n"
      "1403636580838555648,4.5,-1.6,0.7,0.8,0,0,0.6,0.1\n"));
  EXPECT_EQ(file.format, TrajectoryFormat::Euroc);
  EXPECT_EQ(file.poses.at(0).time, Timestamp(1403636580838555648ns));
  EXPECT_EQ(file.poses[0].T_world_camera.translation(), Eigen::Vector3d(4.5, -1.6, 0.7));
  EXPECT_TRUE(file.poses[0].T_world_camera.linear().isApprox(kTurn, 1e-12));
}

TEST(ReadTrajectory, ReadsAFolderOfStrechaCameras) {
  const test::TemporaryDirectory folder;
  const std::string intrinsics = "1379.74 0 760.095 \n0 1382.08 503.155 \n0 0 1 \n0 0 0\n";
  folder.write("0000.jpg.camera", intrinsics + "1 0 0\n0 1 0\n0 0 1\n0 0 0\n1536 1024\n");
  folder.write("0001.jpg.camera", intrinsics + "0 -1 0\n1 0 0\n0 0 1\n1 2 3\n1536 1024\n");
  const TrajectoryFile file = read_trajectory(folder.path());
  EXPECT_EQ(file.format, TrajectoryFormat::Strecha);
  ASSERT_EQ(file.poses.size(), 2u);
  EXPECT_EQ(file.poses[1].time, Timestamp(1s));
  EXPECT_EQ(file.poses[1].T_world_camera.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(file.poses[1].T_world_camera.linear().isApprox(kQuarterTurn, 1e-12));
}

TEST(ReadTrajectory, TimesSevenScenesByTheFrameNumber) {
  const test::TemporaryDirectory folder;
  folder.write("frame-000030.pose.txt", "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n");
  folder.write("frame-000003.pose.txt", "1\t0\t0\t0\n0\t1\t0\t0\n0\t0\t1\t0\n0\t0\t0\t1\n");
  const TrajectoryFile file = read_trajectory(folder.path());
  EXPECT_EQ(file.format, TrajectoryFormat::SevenScenes);
  ASSERT_EQ(file.poses.size(), 2u);
  EXPECT_EQ(file.poses[0].time, Timestamp(100ms));
  EXPECT_EQ(file.poses[1].time, Timestamp(1s));
  EXPECT_EQ(file.poses[1].T_world_camera.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(file.poses[1].T_world_camera.linear().isApprox(kQuarterTurn, 1e-12));
}

TEST(ReadTrajectory, LeavesOutSevenScenesFramesThatTheFusionLost) {
  const test::TemporaryDirectory folder;
  folder.write("frame-000000.pose.txt", "-1.#IND 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_EQ(fault_of(folder, folder.path()).substr(folder.path().string().size()),
            ": all of its poses are marked as lost; give another sequence");
  folder.write("frame-000001.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const TrajectoryFile file = read_trajectory(folder.path());
  ASSERT_EQ(file.poses.size(), 1u);
  EXPECT_EQ(file.poses[0].time, Timestamp(33333333ns));
}

TEST(ReadTrajectory, CountsStrechaCamerasInNaturalOrder) {
  const test::TemporaryDirectory folder;
  std::filesystem::create_directory(folder / "gt_dense_cameras");
  const std::string before_centre = "9 0 4\n0 9 3\n0 0 1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  folder.write("gt_dense_cameras/10.png.camera", before_centre + "10 0 0\n8 6\n");
  folder.write("gt_dense_cameras/9.png.camera", before_centre + "9 0 0\n8 6\n");
  const TrajectoryFile file = read_trajectory(folder.path());
  EXPECT_EQ(file.poses.at(0).T_world_camera.translation().x(), 9.0);
  EXPECT_EQ(file.poses.at(1).T_world_camera.translation().x(), 10.0);
}

TEST(ReadTrajectory, TimesKittiFoldersByTimesTxtOrAtTenHertz) {
  const test::TemporaryDirectory folder;
  folder.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n");
  EXPECT_EQ(read_trajectory(folder.path()).poses.at(1).time, Timestamp(100ms));
  EXPECT_TRUE(read_trajectory(folder.path()).has_times);
  folder.write("times.txt", "0.000000e+00\n1.035600e-01\n");
  EXPECT_EQ(read_trajectory(folder.path()).poses.at(1).time, Timestamp(103560us));
  folder.write("times.txt", "0.0\n0.1\n0.2\n");
  EXPECT_EQ(fault_of(folder, folder.path()),
            "times.txt: has 3 times, poses.txt has 2 poses; both need one line per frame");
  folder.write("times.txt", "0.2\n0.1\n");
  EXPECT_EQ(
      fault_of(folder, folder.path()),
      "times.txt:2: times must increase, got 0.100000000 s after 0.200000000 s; sort the lines by time and remove "
      "repetitions");
}

TEST(ReadTrajectory, FindsThePosesOfAKittiOdometrySequence) {
  const test::TemporaryDirectory folder;
  std::filesystem::create_directories(folder / "sequences/03");
  std::filesystem::create_directories(folder / "poses");
  folder.write("poses/03.txt", "1 0 0 0 0 1 0 0 0 0 1 7\n");
  folder.write("sequences/03/times.txt", "0.5\n");
  const TrajectoryFile file = read_trajectory(folder / "sequences/03");
  EXPECT_EQ(file.poses.at(0).time, Timestamp(500ms));
  EXPECT_EQ(file.poses[0].T_world_camera.translation().z(), 7.0);
}

TEST(ReadTrajectory, MakesRoundedRotationsOrthonormal) {
  const test::TemporaryDirectory folder;
  const auto path = folder.write("00.txt", "0.999 0.04 0 0 -0.04 0.999 0 0 0 0 1 0\n");
  const Eigen::Matrix3d R = read_trajectory(path).poses.at(0).T_world_camera.linear();
  EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

TEST(ReadTrajectory, AcceptsATimeThatIsRepeatedOnce) {
  EXPECT_EQ(fault_of_text("1 0 0 0 0 0 0 1\n1 0 0 1 0 0 0 1\n2 0 0 0 0 0 0 1\n"), "no fault");
}

TEST(ReadTrajectory, NamesFileLineFaultAndRemedy) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  const std::string order = "sort the lines by time and remove repetitions";
  const std::string formats =
      "give TUM (timestamp tx ty tz qx qy qz qw), KITTI (12 numbers), EuRoC csv (t_ns, x, y, z, qw, qx, qy, qz)";
  EXPECT_EQ(fault_of_text(""), "a.txt: holds no pose; " + formats);
  EXPECT_EQ(fault_of_text("# only\n\n"), "a.txt: holds no pose; " + formats);
  EXPECT_EQ(fault_of_text("1 2 3\n"), "a.txt:1: has 3 columns, which is no known trajectory format; " + formats);
  EXPECT_EQ(fault_of_text(good + "2 0 0 0 0 0 1\n"),
            "a.txt:2: has 7 columns, the lines before have 8; correct the line; one file holds one format");
  EXPECT_EQ(fault_of_text(good + "1 0 0 0 0 1 0 0 0 0 1 0\n"),
            "a.txt:2: has 12 columns, the lines before have 8; correct the line; one file holds one format");
  EXPECT_EQ(fault_of_text(good + "\n3 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n"),
            "a.txt:4: times must increase, got 2.000000000 s after 3.000000000 s; " + order);
  EXPECT_EQ(fault_of_text(good + good + good),
            "a.txt:3: times must increase, got 1.000000000 s after 1.000000000 s; " + order);
  EXPECT_EQ(
      fault_of_text(good + "2 0 0 0 0 0 0 0\n"),
      "a.txt:2: the quaternion's norm must be 1, got 0; check the columns' order and remove lines without a pose");
  EXPECT_EQ(
      fault_of_text("1403636579763555584 0 0 0 0 0 0 1\n"),
      "a.txt:1: the timestamp is not a time in seconds: '1403636579763555584'; TUM timestamps are decimal seconds; "
      "correct or remove the line");
  EXPECT_EQ(
      fault_of_text("1 0 0 0 0 1 0 0 0 0 2 0\n"),
      "a.txt:1: the 3x3 part of the pose is not a rotation; check the order of the numbers (rows of [R t]) and that "
      "no scale is in it");
  EXPECT_EQ(fault_of_text("1 0 0 0 0 1 0 0 0 0 -1 0\n").substr(0, 56),
            "a.txt:1: the 3x3 part of the pose is not a rotation; che");
  EXPECT_EQ(fault_of_text("1.5,0,0,0,1,0,0,0\n"),
            "a.txt:1: the timestamp is not an integer of nanoseconds: '1.5'; correct or remove the line");
}

TEST(ReadTrajectory, NamesTheNumberThatIsNone) {
  EXPECT_EQ(fault_of_text("1 0 0 0 0 0 0 1\n2 0 nan 0 0 0 0 1\n").substr(0, 8), "a.txt:2:");
  EXPECT_EQ(fault_of_text("1 0 x 0 0 0 0 1\n").substr(0, 8), "a.txt:1:");
  EXPECT_EQ(fault_of_text("1 0 0 inf 0 1 0 0 0 0 1 0\n").substr(0, 8), "a.txt:1:");
  EXPECT_NE(fault_of_text("2 0 nan 0 0 0 0 1\n").find("nan"), std::string::npos);
}

TEST(ReadTrajectory, NamesTheFileOfAFolderThatIsWrong) {
  const test::TemporaryDirectory folder;
  EXPECT_EQ(fault_of(folder, folder.path() / "none"), "none: does not exist; check the path");
  EXPECT_NE(fault_of(folder, folder.path()).find("holds no known trajectory"), std::string::npos);
  folder.write("frame-000001.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n");
  EXPECT_EQ(fault_of(folder, folder.path()),
            "frame-000001.pose.txt:3: has 3 rows of numbers, a 4x4 pose has 4; copy the file again from its source");
  folder.write("frame-000001.pose.txt", "1 0 0 0\n0 1 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_EQ(fault_of(folder, folder.path()),
            "frame-000001.pose.txt:2: has 3 columns, a row of a 4x4 pose has 4; copy the file again from its source");
  folder.write("frame-000001.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n");
  EXPECT_EQ(fault_of(folder, folder.path()),
            "frame-000001.pose.txt:4: the last row of a pose must be 0 0 0 1; check the row order");
}

TEST(ReadTrajectory, ReadsTheRecordings) {
  struct Expected {
    const char* folder;
    TrajectoryFormat format;
    std::size_t count;
    double length_m;
  };
  for (const Expected& expected : {Expected{"fountain", TrajectoryFormat::Strecha, 11, 16.95},
                                   Expected{"seven-scenes", TrajectoryFormat::SevenScenes, 400, 3.0},
                                   Expected{"kitti-clip", TrajectoryFormat::Kitti, 51, 59.86},
                                   Expected{"tum-fr1-rpy", TrajectoryFormat::Tum, 997, 0.93}}) {
    const auto folder = test::data_directory(expected.folder);
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
    const TrajectoryFile file = read_trajectory(folder);
    EXPECT_EQ(file.format, expected.format) << expected.folder;
    EXPECT_EQ(file.poses.size(), expected.count) << expected.folder;
    EXPECT_NEAR(path_length(file.poses), expected.length_m, 0.01) << expected.folder;
  }
}

Trajectory awkward_trajectory() {
  Trajectory trajectory(3);
  trajectory[0].time = Timestamp(-1ns);
  trajectory[1].time = Timestamp(1305031229528748001ns);
  trajectory[1].T_world_camera.translation() = Eigen::Vector3d(1.0 / 3.0, -1e-300, 12345678.9012345678);
  trajectory[1].T_world_camera.linear() = exp_so3({0.1, -2.0, 1.5});
  trajectory[2].time = Timestamp(1305031229528748002ns);
  trajectory[2].T_world_camera.linear() = exp_so3({3.14159, 0, 0});
  return trajectory;
}

TEST(WriteTrajectoryTum, IsReadBackExactly) {
  const test::TemporaryDirectory folder;
  const Trajectory written = awkward_trajectory();
  write_trajectory_tum(folder / "a.tum", written);
  const Trajectory read = read_trajectory(folder / "a.tum").poses;
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].time, written[i].time);
    EXPECT_EQ(read[i].T_world_camera.translation(), written[i].T_world_camera.translation());
    EXPECT_LT((read[i].T_world_camera.linear() - written[i].T_world_camera.linear()).norm(), 1e-15);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.tum.part"));
}

TEST(WriteTrajectoryTum, HasAHeaderThatNamesOrderAndUnits) {
  const test::TemporaryDirectory folder;
  write_trajectory_tum(folder / "a.tum", {StampedPose{}});
  EXPECT_EQ(text_of(folder / "a.tum"),
            "# timestamp[s] tx ty tz[m] qx qy qz qw: camera to world\n0.000000000 0 0 0 0 0 0 1\n");
}

TEST(WriteTrajectoryTum, SaysWhereItCannotWrite) {
  const test::TemporaryDirectory folder;
  EXPECT_THROW(write_trajectory_tum(folder / "missing/a.tum", {StampedPose{}}), DeviceError);
}

}  // namespace
}  // namespace alidade
