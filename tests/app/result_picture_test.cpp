// SPDX-License-Identifier: Apache-2.0
#include "app/result_picture.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/errors.h"
#include "geometry/alignment.h"
#include "io/camera_file.h"
#include "io/map_file.h"
#include "io/trajectory_file.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

Trajectory winding(int count) {
  Trajectory trajectory(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    auto& pose = trajectory[static_cast<std::size_t>(i)];
    pose.time = Timestamp(std::chrono::seconds(i));
    pose.T_world_camera.translation() = Eigen::Vector3d(i, std::sin(i), std::cos(2.0 * i));
  }
  return trajectory;
}

TEST(ResultPicture, BringsTheTruthIntoTheFrameOfTheEstimate) {
  const test::TemporaryDirectory temporary;
  Similarity elsewhere;
  elsewhere.scale = 3;
  elsewhere.T_target_source = Eigen::Translation3d(5, 6, 7) * Eigen::AngleAxisd(1, Eigen::Vector3d::UnitY());
  write_trajectory_tum(temporary.path() / "trajectory.tum", winding(10));
  write_trajectory_tum(temporary.path() / "truth.tum", transform(elsewhere, winding(20)));
  const ResultPicture result = read_result_picture(temporary.path(), {});
  ASSERT_TRUE(result.picture.truth);
  ASSERT_EQ(result.picture.truth->size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_TRUE((*result.picture.truth)[i].T_world_camera.isApprox(winding(20)[i].T_world_camera, 1e-6)) << i;
  }
  EXPECT_TRUE(result.warnings.empty());
}

TEST(ResultPicture, ReadsMapAndCameraWhereTheyAre) {
  const test::TemporaryDirectory temporary;
  write_trajectory_tum(temporary.path() / "trajectory.tum", winding(10));
  EXPECT_FALSE(read_result_picture(temporary.path(), {}).picture.camera);
  PointMap map;
  map.points.resize(3);
  write_map_ply(temporary.path() / "map.ply", map);
  write_camera(temporary.path() / "camera.yaml", {64, 48, 50, 50, 31.5, 23.5, {}});
  const ResultPicture result = read_result_picture(temporary.path(), {});
  EXPECT_EQ(result.picture.map.points.size(), 3u);
  EXPECT_EQ(result.picture.camera->width, 64);
  EXPECT_EQ(result.picture.estimate.size(), 10u);
}

TEST(ResultPicture, TellsOfATruthThatCannotBeAligned) {
  const test::TemporaryDirectory temporary;
  write_trajectory_tum(temporary.path() / "trajectory.tum", winding(10));
  Trajectory later = winding(10);
  for (auto& pose : later) pose.time += std::chrono::hours(1);
  write_trajectory_tum(temporary.path() / "later.tum", later);
  const ResultPicture result = read_result_picture(temporary.path(), temporary.path() / "later.tum");
  EXPECT_FALSE(result.picture.truth);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_NE(result.warnings[0].find("later.tum is not drawn"), std::string::npos);
}

TEST(ResultPicture, TakesATrajectoryFileOrATruthAlone) {
  const test::TemporaryDirectory temporary;
  write_trajectory_tum(temporary.path() / "truth.tum", winding(5));
  EXPECT_EQ(read_result_picture(temporary.path(), {}).picture.truth->size(), 5u);
  EXPECT_TRUE(read_result_picture(temporary.path(), {}).picture.estimate.empty());
  EXPECT_EQ(read_result_picture(temporary.path() / "truth.tum", {}).picture.estimate.size(), 5u);
}

TEST(ResultPicture, RefusesAFolderWithNothingToDraw) {
  const test::TemporaryDirectory temporary;
  try {
    read_result_picture(temporary.path(), {});
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("holds nothing to draw; give a result directory"), std::string::npos);
  }
}

}  // namespace
}  // namespace alidade
