// SPDX-License-Identifier: Apache-2.0
#include "view/renderer.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "camera/camera.h"
#include "geometry/pose.h"

namespace alidade {
namespace {

// Off-centre, fx and fy apart, odd size: every half-pixel slip shows.
Camera odd_camera() {
  Camera camera;
  camera.width = 321;
  camera.height = 202;
  camera.fx = 300;
  camera.fy = 260;
  camera.cx = 130.3;
  camera.cy = 117.8;
  return camera;
}

// A white square facing the camera's axis, centred at p.
TexturedSurface square(const Eigen::Vector3d& p, double side, const cv::Mat& texture) {
  const double h = side / 2;
  return {{p + Eigen::Vector3d(-h, -h, 0), p + Eigen::Vector3d(h, -h, 0), p + Eigen::Vector3d(h, h, 0),
           p + Eigen::Vector3d(-h, h, 0)},
          {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
          {{0, 1, 2}, {0, 2, 3}},
          texture};
}

// Turned within its plane, so that its edges cross pixels in all phases; the centroid of its image is the image of its
// centre.
TexturedSurface slanted_square(const Eigen::Vector3d& p, const cv::Mat& texture) {
  TexturedSurface surface = square(Eigen::Vector3d::Zero(), 0.12, texture);  // about 18 px
  const Eigen::AngleAxisd turn(0.4, Eigen::Vector3d::UnitZ());
  for (auto& v : surface.vertices_world) v = p + turn * v;
  return surface;
}

cv::Mat plain(const cv::Scalar& bgr) {
  return {8, 8, CV_8UC3, bgr};
}

cv::Point2d centroid(const cv::Mat& bgr) {
  cv::Mat grey;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  const cv::Moments m = cv::moments(grey);
  return {m.m10 / m.m00, m.m01 / m.m00};
}

Scene black_scene() {
  Scene scene;
  scene.background = {0, 0, 0};
  return scene;
}

TEST(RenderCamera, ShowsAPointWhereProjectSaysToATwentiethOfAPixel) {
  const Camera camera = odd_camera();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  Renderer renderer;
  for (int trial = 0; trial < 12; ++trial) {
    Vector6d xi;
    for (int i = 0; i < 6; ++i) xi[i] = u(random);
    const Eigen::Isometry3d T_world_camera = perturbation(xi);
    const Eigen::Vector3d p_camera(0.6 * u(random), 0.4 * u(random), 2.0);
    Scene scene = black_scene();
    scene.surfaces.push_back(slanted_square(p_camera, plain(cv::Scalar::all(255))));
    for (auto& v : scene.surfaces[0].vertices_world) v = T_world_camera * v;
    renderer.show(scene);
    const auto expected = project(camera, p_camera);
    for (int supersampling : {2, 3}) {
      const cv::Point2d found = centroid(renderer.render(camera, T_world_camera, supersampling));
      EXPECT_NEAR(found.x, expected->pixel.x(), 0.05) << trial << " " << supersampling;
      EXPECT_NEAR(found.y, expected->pixel.y(), 0.05) << trial << " " << supersampling;
    }
  }
}

TEST(RenderCamera, IsExactOnAverage) {
  const Camera camera = odd_camera();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> u(-1, 1);
  Renderer renderer;
  constexpr int kTrials = 40;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), sum_without_supersampling = Eigen::Vector2d::Zero();
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Vector3d p(0.6 * u(random), 0.4 * u(random), 2.0);
    Scene scene = black_scene();
    scene.surfaces.push_back(slanted_square(p, plain(cv::Scalar::all(255))));
    renderer.show(scene);
    const cv::Point2d found = centroid(renderer.render(camera, Eigen::Isometry3d::Identity(), 2));
    sum += Eigen::Vector2d(found.x, found.y) - project(camera, p)->pixel;
    const cv::Point2d rough = centroid(renderer.render(camera, Eigen::Isometry3d::Identity(), 1));
    sum_without_supersampling += Eigen::Vector2d(rough.x, rough.y) - project(camera, p)->pixel;
  }
  // A slip of half a supersampled pixel would be 0.25.
  EXPECT_LT((sum / kTrials).norm(), 0.005) << (sum / kTrials).transpose();
  EXPECT_LT((sum_without_supersampling / kTrials).norm(), 0.05) << sum_without_supersampling.transpose() / kTrials;
}

TEST(RenderCamera, TextureLiesUprightAndUnmirrored) {
  cv::Mat texture = plain(cv::Scalar::all(40));
  texture(cv::Rect(0, 0, 4, 4)) = cv::Scalar(255, 0, 0);  // blue top left
  texture(cv::Rect(4, 0, 4, 4)) = cv::Scalar(0, 0, 255);  // red top right
  Scene scene = black_scene();
  scene.surfaces.push_back(square({0, 0, 1}, 0.4, texture));
  Renderer renderer;
  renderer.show(scene);
  const Camera camera = odd_camera();
  const cv::Mat picture = renderer.render(camera, Eigen::Isometry3d::Identity());
  const auto at = [&](double x, double y) {
    const Eigen::Vector2d pixel = project(camera, {x, y, 1})->pixel;
    return picture.at<cv::Vec3b>(int(std::lround(pixel.y())), int(std::lround(pixel.x())));
  };
  EXPECT_EQ(at(-0.1, -0.1), cv::Vec3b(255, 0, 0));
  EXPECT_EQ(at(0.1, -0.1), cv::Vec3b(0, 0, 255));
  EXPECT_EQ(at(0.1, 0.1), cv::Vec3b(40, 40, 40));
  EXPECT_EQ(at(0.3, 0.1), cv::Vec3b(0, 0, 0));
}

TEST(RenderCamera, NearHidesFarAlsoFarFromTheOrigin) {
  const Eigen::Vector3d far_away(4.5e5, 5.3e6, 300);  // as map coordinates are
  Scene scene = black_scene();
  scene.surfaces = {square(far_away + Eigen::Vector3d(0, 0, 2), 5, plain({255, 0, 0})),
                    square(far_away + Eigen::Vector3d(0, 0, 1.99), 0.2, plain({0, 255, 0}))};
  Renderer renderer;
  renderer.show(scene);
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.translation() = far_away;
  const cv::Mat picture = renderer.render(odd_camera(), T_world_camera);
  EXPECT_EQ(picture.at<cv::Vec3b>(118, 130), cv::Vec3b(0, 255, 0));
  EXPECT_EQ(picture.at<cv::Vec3b>(118, 200), cv::Vec3b(255, 0, 0));
}

TEST(RenderDepth, IsTheDepthAlongTheAxisAtThePixelsCentre) {
  const Camera camera = odd_camera();
  // A plane n·p = d tilted to the camera.
  const Eigen::Vector3d n = Eigen::Vector3d(0.3, -0.2, 1).normalized();
  const double d = 2.0;
  Scene scene = black_scene();
  TexturedSurface plane = square({0, 0, 0}, 3, plain(cv::Scalar::all(9)));
  for (auto& v : plane.vertices_world) v.z() = (d - n.x() * v.x() - n.y() * v.y()) / n.z();
  scene.surfaces.push_back(plane);
  Renderer renderer;
  renderer.show(scene);
  const cv::Mat depth = renderer.render_depth(camera, Eigen::Isometry3d::Identity());
  ASSERT_EQ(depth.type(), CV_32FC1);
  int seen = 0;
  for (int y = 0; y < depth.rows; y += 13) {
    for (int x = 0; x < depth.cols; x += 11) {
      const Eigen::Vector3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
      if (depth.at<float>(y, x) == 0) continue;
      EXPECT_NEAR(depth.at<float>(y, x), d / n.dot(ray), 2e-4);
      ++seen;
    }
  }
  EXPECT_GT(seen, 300);
  EXPECT_EQ(renderer.render_depth(camera, perturbation((Vector6d() << 0, 0, 0, 0, 3.1, 0).finished())).at<float>(5, 5),
            0);
}

TEST(RenderViewpoint, PointsKeepTheirColourAndPlace) {
  Scene scene = black_scene();
  scene.points = {{{0.2, 0.1, 1}, {10, 200, 30}}};
  scene.point_size_px = 6;
  Renderer renderer;
  renderer.show(scene);
  Viewpoint view;
  view.eye_world = Eigen::Vector3d::Zero();
  view.target_world = {0, 0, 1};
  const cv::Mat picture = renderer.render(view, {200, 150});
  const Eigen::Vector2d expected = project(camera_of(view, {200, 150}), scene.points[0].p_world)->pixel;
  EXPECT_NEAR(centroid(picture).x, expected.x(), 0.3);
  EXPECT_NEAR(centroid(picture).y, expected.y(), 0.3);
  const int x = int(std::lround(expected.x())), y = int(std::lround(expected.y()));
  EXPECT_EQ(picture.at<cv::Vec3b>(y, x), cv::Vec3b(30, 200, 10));
}

TEST(RenderViewpoint, SolidPyramidsAreFilledAndHollowOnesAreNot) {
  const auto coverage = [](PyramidStyle style) {
    Scene scene = black_scene();
    CameraPyramid pyramid;
    pyramid.style = style;
    pyramid.depth_m = 0.5;
    pyramid.colour = {255, 0, 0};
    scene.cameras = {pyramid};
    const cv::Mat picture = render(scene, frame_scene(scene), {300, 200});
    cv::Mat mask;
    cv::inRange(picture, cv::Scalar(0, 0, 60), cv::Scalar(20, 20, 255), mask);
    return cv::countNonZero(mask);
  };
  const int solid = coverage(PyramidStyle::Solid), hollow = coverage(PyramidStyle::Hollow);
  EXPECT_GT(hollow, 300);
  EXPECT_GT(solid, 4 * hollow);
}

TEST(RenderViewpoint, PathsHaveGapsWhereAPointIsNotFinite) {
  Scene scene = black_scene();
  const double nan = std::nan("");
  scene.paths = {{{{-0.2, 0, 1}, {-0.1, 0, 1}, {nan, nan, nan}, {0.1, 0, 1}, {0.2, 0, 1}}, {255, 255, 255}, 3}};
  Viewpoint view;
  view.eye_world = Eigen::Vector3d::Zero();
  view.target_world = {0, 0, 1};
  const cv::Mat picture = render(scene, view, {301, 201});
  const Camera camera = camera_of(view, {301, 201});
  const auto brightness = [&](double x) {
    return int(picture.at<cv::Vec3b>(100, int(std::lround(project(camera, {x, 0, 1})->pixel.x())))[1]);
  };
  EXPECT_GT(brightness(-0.15), 200);
  EXPECT_EQ(brightness(0.0), 0);
  EXPECT_GT(brightness(0.15), 200);
}

TEST(RenderViewpoint, WritesTitleLegendAndLabels) {
  Scene scene = black_scene();
  scene.labels = {{{0, 0, 1}, "marker", {255, 255, 255}}};
  scene.points = {{{0, 0, 1}, {1, 1, 1}}};
  Viewpoint view;
  view.eye_world = Eigen::Vector3d::Zero();
  view.target_world = {0, 0, 1};
  const cv::Mat labelled = render(scene, view, {300, 200});
  EXPECT_GT(cv::norm(labelled(cv::Rect(150, 90, 100, 20)), cv::NORM_INF), 200);
  scene.labels.clear();
  scene.title = "Fountain";
  scene.legend = {{"true", {255, 0, 0}, PyramidStyle::Solid}};
  const cv::Mat titled = render(scene, view, {300, 200});
  EXPECT_GT(cv::norm(titled(cv::Rect(0, 0, 120, 50)), cv::NORM_INF), 200);
  EXPECT_LT(cv::norm(titled(cv::Rect(150, 90, 100, 20)), cv::NORM_INF), 10);
}

TEST(RenderViewpoint, WritesALabelToTheLeftWhereItWouldRunOverTheBorder) {
  Scene scene = black_scene();
  Viewpoint view;
  view.eye_world = Eigen::Vector3d::Zero();
  view.target_world = {0, 0, 1};
  const cv::Size size(300, 200);
  const Eigen::Vector3d near_border = *unproject(camera_of(view, size), {290, 100});
  scene.labels = {{near_border, "camera2", {255, 255, 255}}};
  scene.points = {{near_border, {1, 1, 1}}};
  const cv::Mat picture = render(scene, view, size);
  EXPECT_GT(cv::norm(picture(cv::Rect(230, 90, 50, 20)), cv::NORM_INF), 200);
  EXPECT_LT(cv::norm(picture(cv::Rect(291, 90, 9, 20)), cv::NORM_INF), 10);
}

TEST(Renderer, ShowReplacesTheScene) {
  Renderer renderer;
  Scene full = black_scene();
  full.surfaces.push_back(square({0, 0, 1}, 9, plain(cv::Scalar::all(255))));
  renderer.show(full);
  const Camera camera = odd_camera();
  EXPECT_EQ(cv::mean(renderer.render(camera, Eigen::Isometry3d::Identity()))[0], 255);
  renderer.show(black_scene());
  EXPECT_EQ(cv::mean(renderer.render(camera, Eigen::Isometry3d::Identity()))[0], 0);
}

TEST(RenderViewpoint, WhatLiesBehindShowsThroughATranslucentSurface) {
  Scene scene = black_scene();
  scene.surfaces.push_back(square({0, 0, 2}, 4, plain(cv::Scalar::all(200))));
  const TexturedSurface shape = square({0, 0, 1}, 0.2, plain(cv::Scalar::all(0)));
  scene.translucent.push_back({shape.vertices_world, shape.triangles, {100, 0, 0}, 0.25});
  Renderer renderer;
  renderer.show(scene);
  Viewpoint view;
  view.eye_world = Eigen::Vector3d::Zero();
  view.target_world = {0, 0, 1};
  const cv::Mat picture = renderer.render(view, {200, 150});
  const cv::Vec3b through = picture.at<cv::Vec3b>(75, 100), beside = picture.at<cv::Vec3b>(20, 30);
  EXPECT_EQ(beside, cv::Vec3b(200, 200, 200));
  EXPECT_NEAR(through[0], 150, 3);  // 0.75 * 200
  EXPECT_NEAR(through[2], 175, 3);  // 0.75 * 200 + 0.25 * 100
}

TEST(Renderer, RefusesSurfacesThatDoNotFitAndImpossibleCameras) {
  Renderer renderer;
  Scene scene;
  scene.surfaces.push_back(square({0, 0, 1}, 1, plain(cv::Scalar::all(1))));
  scene.surfaces[0].triangles[0][1] = 4;
  EXPECT_THROW(renderer.show(scene), std::invalid_argument);
  scene.surfaces.clear();
  scene.translucent.push_back({{{0, 0, 1}}, {{0, 0, 1}}, palette::kInk, 0.5});
  EXPECT_THROW(renderer.show(scene), std::invalid_argument);
  EXPECT_THROW(renderer.render(Camera{}, Eigen::Isometry3d::Identity()), std::invalid_argument);
  EXPECT_THROW(renderer.render(odd_camera(), Eigen::Isometry3d::Identity(), 0), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
