// SPDX-License-Identifier: Apache-2.0
#include "view/scene.h"

#include <cmath>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using namespace std::chrono_literals;

Trajectory line(int count) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    StampedPose pose;
    pose.time = Timestamp(i * 1s);
    pose.T_world_camera.translation() = Eigen::Vector3d(i, 0, 0);
    trajectory.push_back(pose);
  }
  return trajectory;
}

TEST(ScenePoints, AreThinnedEvenly) {
  PointMap map;
  for (int i = 0; i < 1000; ++i) {
    map.points.emplace_back();
    map.points.back().p_world.x() = i;
    map.points.back().rgb = {1, 2, 3};
  }
  EXPECT_EQ(scene_points(map).size(), 1000u);
  EXPECT_EQ(scene_points(map)[7].colour, (Rgb{1, 2, 3}));
  const auto thinned = scene_points(map, 10);
  ASSERT_EQ(thinned.size(), 10u);
  EXPECT_EQ(thinned.front().p_world.x(), 0);
  EXPECT_EQ(thinned.back().p_world.x(), 999);
  for (std::size_t i = 1; i < 10; ++i) EXPECT_NEAR(thinned[i].p_world.x() - thinned[i - 1].p_world.x(), 111, 1);
}

TEST(ScenePath, BreaksAtLongGapsOnly) {
  Trajectory trajectory = line(4);
  trajectory[3].time += 10s;
  EXPECT_EQ(scene_path(trajectory, palette::kTruth).points_world.size(), 4u);
  const auto broken = scene_path(trajectory, palette::kTruth, 5s);
  ASSERT_EQ(broken.points_world.size(), 5u);
  EXPECT_TRUE(std::isnan(broken.points_world[3].x()));
  EXPECT_EQ(broken.points_world[4].x(), 3);
}

TEST(ScenePyramids, KeepFirstAndLastAndTheShapeOfTheCamera) {
  Camera camera;
  camera.width = 600;
  camera.height = 400;
  camera.fx = camera.fy = 500;
  const auto pyramids = scene_pyramids(line(100), PyramidStyle::Solid, palette::kTruth, camera, 12);
  ASSERT_EQ(pyramids.size(), 12u);
  EXPECT_EQ(pyramids.front().T_world_camera.translation().x(), 0);
  EXPECT_EQ(pyramids.back().T_world_camera.translation().x(), 99);
  EXPECT_TRUE(pyramids[3].half_extent.isApprox(Eigen::Vector2d(0.6, 0.4)));
  EXPECT_EQ(pyramids[3].style, PyramidStyle::Solid);
  EXPECT_TRUE(scene_pyramids({}, PyramidStyle::Solid, palette::kTruth).empty());
}

TEST(TrackScene, ShowsTruthSolidAndEstimateHollow) {
  TrackPicture picture;
  picture.estimate = line(10);
  picture.truth = line(10);
  const Scene scene = track_scene(picture);
  ASSERT_EQ(scene.cameras.size(), 20u);
  EXPECT_EQ(scene.cameras.front().style, PyramidStyle::Solid);
  EXPECT_EQ(scene.cameras.back().style, PyramidStyle::Hollow);
  EXPECT_EQ(scene.paths.size(), 2u);
  EXPECT_EQ(scene.legend.size(), 2u);
  EXPECT_GT(scene.pyramid_depth_m, 0.02 * 9);
  EXPECT_LT(scene.pyramid_depth_m, 0.2 * 9);
  picture.truth.reset();
  EXPECT_EQ(track_scene(picture).cameras.size(), 10u);
}

TEST(PyramidCorners, SpanTheViewAtTheDepth) {
  CameraPyramid pyramid;
  pyramid.T_world_camera.translation() = Eigen::Vector3d(1, 2, 3);
  pyramid.half_extent = {0.5, 0.4};
  Scene scene;
  scene.pyramid_depth_m = 2;
  const auto corners = pyramid_corners(pyramid, scene);
  ASSERT_EQ(corners.size(), 5u);
  EXPECT_TRUE(corners[0].isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_TRUE(corners[1].isApprox(Eigen::Vector3d(0, 1.2, 5)));
  EXPECT_TRUE(corners[3].isApprox(Eigen::Vector3d(2, 2.8, 5)));
  pyramid.depth_m = 1;
  EXPECT_TRUE(pyramid_corners(pyramid, scene)[3].isApprox(Eigen::Vector3d(1.5, 2.4, 4)));
}

TEST(TrackScene, ShowsATruthAlone) {
  TrackPicture picture;
  picture.truth = line(10);
  const Scene scene = track_scene(picture);
  EXPECT_EQ(scene.cameras.size(), 10u);
  EXPECT_EQ(scene.legend.size(), 1u);
  EXPECT_GT(scene.pyramid_depth_m, 0.02 * 9);
}

TEST(TrackScene, HasPyramidsToSeeWhereTheCameraOnlyTurned) {
  TrackPicture picture;
  picture.estimate = {StampedPose{}, StampedPose{}};
  EXPECT_GT(track_scene(picture).pyramid_depth_m, 0);
  picture.map.points.resize(3);
  for (auto& point : picture.map.points) point.p_world.z() = 10;
  EXPECT_NEAR(track_scene(picture).pyramid_depth_m, 0.25, 1e-9);
}

TEST(CovarianceEllipsoid, LiesAsManyStandardDeviationsAway) {
  Eigen::Matrix3d covariance;
  covariance << 4, 1, 0, 1, 2, 0.5, 0, 0.5, 1;
  const Eigen::Vector3d mean(1, 2, 3);
  const TranslucentSurface surface = covariance_ellipsoid(mean, 1e-6 * covariance, 3.0, palette::kEstimate);
  ASSERT_FALSE(surface.triangles.empty());
  for (const auto& vertex : surface.vertices_world) {
    const Eigen::Vector3d off = vertex - mean;
    EXPECT_NEAR(off.dot((1e-6 * covariance).inverse() * off), 9.0, 1e-6);
  }
  for (const auto& triangle : surface.triangles) {
    EXPECT_GE(triangle.minCoeff(), 0);
    EXPECT_LT(triangle.maxCoeff(), static_cast<int>(surface.vertices_world.size()));
  }
}

TEST(CovarianceEllipsoid, IsFlatWhereTheCovarianceIs) {
  const Eigen::Matrix3d flat = Eigen::Vector3d(1, 1, 0).asDiagonal();
  for (const auto& vertex : covariance_ellipsoid({0, 0, 5}, flat, 2.0, palette::kInk).vertices_world) {
    EXPECT_NEAR(vertex.z(), 5.0, 1e-12);
  }
}

}  // namespace
}  // namespace alidade
