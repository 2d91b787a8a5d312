// SPDX-License-Identifier: Apache-2.0
#include "view/viewpoint.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "geometry/pose.h"

namespace alidade {
namespace {

const cv::Size kSize(600, 400);

Eigen::Vector2d seen_at(const Viewpoint& view, const Eigen::Vector3d& p_world) {
  const auto projection = project(camera_of(view, kSize), T_world_camera_of(view).inverse() * p_world);
  return projection ? projection->pixel : Eigen::Vector2d(-1, -1);
}

Scene cloud(unsigned seed, double stretch) {
  Scene scene;
  std::mt19937 random(seed);
  std::normal_distribution<double> n(0, 1);
  for (int i = 0; i < 500; ++i) scene.points.push_back({{5 + stretch * n(random), n(random), 2 + n(random)}, {}});
  return scene;
}

TEST(Viewpoint, ShowsItsTargetInTheMiddleAndUpAbove) {
  Viewpoint view;
  view.eye_world = {3, -2, 1};
  view.target_world = {0.5, 0.2, 0.1};
  view.up_world = Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(seen_at(view, view.target_world).isApprox(Eigen::Vector2d(299.5, 199.5), 1e-9));
  const Eigen::Vector2d above = seen_at(view, view.target_world + 0.3 * view.up_world);
  EXPECT_NEAR(above.x(), 299.5, 1e-6);
  EXPECT_LT(above.y(), 190);
}

TEST(Viewpoint, IsARotationEvenWhenLookingAlongUp) {
  Viewpoint view;
  view.eye_world = {0, 0, 5};
  view.up_world = Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d R = T_world_camera_of(view).linear();
  EXPECT_TRUE((R.transpose() * R).isIdentity(1e-12));
  EXPECT_NEAR(R.determinant(), 1, 1e-12);
}

TEST(Turned, ComesRoundAfterAFullTurnAndKeepsHeight) {
  Viewpoint view;
  view.eye_world = {3, -2, 1};
  view.up_world = Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(turned(view, 2 * std::numbers::pi).eye_world.isApprox(view.eye_world, 1e-12));
  EXPECT_NEAR(turned(view, 1.0).eye_world.z(), 1, 1e-12);
  EXPECT_TRUE(turned(view, std::numbers::pi).eye_world.isApprox(Eigen::Vector3d(-3, 2, 1), 1e-12));
}

TEST(FrameScene, FillsThePictureWithTheScene) {
  for (const double stretch : {0.2, 1.0, 8.0}) {
    for (const double azimuth : {-2.0, 0.0, 1.0}) {
      const Scene scene = cloud(4, stretch);
      const Viewpoint view = frame_scene(scene, {azimuth, 0.4, 1.0}, 1.5);
      int inside = 0;
      double widest = 0;
      for (const auto& point : scene.points) {
        const Eigen::Vector2d at = seen_at(view, point.p_world);
        const bool in = at.x() >= 0 && at.y() >= 0 && at.x() <= 599 && at.y() <= 399;
        inside += in;
        if (in) widest = std::max({widest, std::abs(at.x() - 299.5) / 300, std::abs(at.y() - 199.5) / 200});
      }
      EXPECT_GE(inside, 440) << stretch << " " << azimuth;
      EXPECT_GT(widest, 0.7) << stretch << " " << azimuth;
    }
  }
}

TEST(FrameScene, IsNotShrunkByWildPoints) {
  Scene scene = cloud(5, 1.0);
  const double distance = (frame_scene(scene).eye_world - frame_scene(scene).target_world).norm();
  for (int i = 0; i < 10; ++i) scene.points.push_back({{1e5 * i, -1e6, 1e4}, {}});
  scene.points.push_back({Eigen::Vector3d::Constant(std::nan("")), {}});
  const Viewpoint view = frame_scene(scene);
  EXPECT_NEAR((view.eye_world - view.target_world).norm(), distance, 0.15 * distance);
}

TEST(FrameScene, ShowsEveryCameraAndPathPoint) {
  Scene scene = cloud(6, 1.0);
  for (int i = 0; i < 20; ++i) {
    scene.cameras.emplace_back();
    scene.cameras.back().T_world_camera.translation() = Eigen::Vector3d(0.4 * i, 0.1 * i, -12);
  }
  scene.paths.push_back({{{0, 0, -12}, {9, 3, -14}}, {}, 2});
  const Viewpoint view = frame_scene(scene, {}, 1.5);
  const Camera camera = camera_of(view, kSize);
  for (const auto& pyramid : scene.cameras) {
    for (const auto& corner : pyramid_corners(pyramid, scene)) EXPECT_TRUE(is_inside(camera, seen_at(view, corner)));
  }
  EXPECT_TRUE(is_inside(camera, seen_at(view, {9, 3, -14})));
}

TEST(FrameScene, LooksFromBehindAndAboveTheCameras) {
  Scene scene;
  const Eigen::Isometry3d T = perturbation((Vector6d() << 1, 2, 3, 0.4, -0.8, 0.2).finished());
  for (int i = 0; i < 5; ++i) {
    scene.cameras.emplace_back();
    scene.cameras.back().T_world_camera = T * perturbation((Vector6d() << 0.1 * i, 0, 0, 0, 0, 0).finished());
  }
  const Viewpoint view = frame_scene(scene, {0.0, 0.5, 1.0});
  const Eigen::Vector3d from_camera = T.linear().transpose() * (view.eye_world - view.target_world);
  EXPECT_LT(from_camera.z(), 0);  // behind
  EXPECT_LT(from_camera.y(), 0);  // above
  EXPECT_NEAR(std::atan2(-from_camera.y(), -from_camera.z()), 0.5, 1e-9);
  EXPECT_GT((T.linear().transpose() * (frame_scene(scene, {0.6, 0.5, 1.0}).eye_world - view.target_world)).x(), 0);
}

TEST(FrameScene, TakesTheScenesWordForUp) {
  Scene scene;
  scene.cameras.emplace_back();  // whose up is -y
  scene.up_world = Eigen::Vector3d::UnitZ();
  scene.paths.push_back({{{0, 0, 0}, {1, 1, 0}}, palette::kInk, 1.0});
  const Viewpoint view = frame_scene(scene, {0.3, 0.5, 1.0});
  EXPECT_TRUE(view.up_world.isApprox(Eigen::Vector3d::UnitZ()));
  const Eigen::Vector3d backward = (view.eye_world - view.target_world).normalized();
  EXPECT_NEAR(std::asin(backward.z()), 0.5, 1e-9);
}

TEST(FrameScene, CopesWithNothingAndWithASinglePoint) {
  EXPECT_TRUE(frame_scene({}).eye_world.allFinite());
  Scene scene;
  scene.points = {{{7, 8, 9}, {}}};
  const Viewpoint view = frame_scene(scene);
  EXPECT_TRUE(view.eye_world.allFinite());
  EXPECT_NEAR((view.target_world - Eigen::Vector3d(7, 8, 9)).norm(), 0, 1e-9);
  EXPECT_GT((view.eye_world - view.target_world).norm(), 0.1);
}

}  // namespace
}  // namespace alidade
