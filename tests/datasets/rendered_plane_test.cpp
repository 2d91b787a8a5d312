// SPDX-License-Identifier: Apache-2.0
#include "datasets/rendered_plane.h"

#include <chrono>
#include <random>

#include <gtest/gtest.h>

namespace alidade {
namespace {

// Black left of x = 0.1 m (or above y = 0.1 m, upright = false), white right of it, 4 texels per mm.
PlaneTexture half_plane(bool upright) {
  PlaneTexture texture{cv::Mat(800, 800, CV_8UC1, cv::Scalar(255)), 4000, {-0.5, -0.5}};
  texture.grey(upright ? cv::Rect(0, 0, 400, 800) : cv::Rect(0, 0, 800, 400)).setTo(0);
  return texture;
}

Eigen::Isometry3d tilted_pose() {
  Eigen::Isometry3d T_camera_plane = Eigen::Isometry3d::Identity();
  T_camera_plane.linear() = (Eigen::AngleAxisd(0.5, Eigen::Vector3d(0.6, 0.7, 0.2).normalized())).toRotationMatrix();
  T_camera_plane.translation() =
      Eigen::Vector3d(0.02, 0.03, 0.25) - T_camera_plane.linear() * Eigen::Vector3d(0.1, 0.1, 0);
  return T_camera_plane;
}

Eigen::Vector2d true_pixel(const Camera& camera, const Eigen::Isometry3d& T_camera_plane, const PlaneBulge& bulge,
                           const Eigen::Vector2d& p) {
  return project(camera, T_camera_plane * Eigen::Vector3d(p.x(), p.y(), height_m(bulge, p)))->pixel;
}

// The largest distance between where the edge is drawn and where project() has it, px. Across an edge that runs along
// `along`, the sum of the grey values of a line of pixels says where it lies.
double edge_error_px(const Camera& camera, bool upright, const PlaneRenderOptions& options) {
  constexpr int kReach_px = 6;
  const Eigen::Isometry3d T = tilted_pose();
  const cv::Mat grey = render_plane(camera, T, half_plane(upright), options);
  const int along = upright ? 1 : 0;
  double worst = 0;
  int checked = 0;
  for (double s = 0.06; s < 0.14; s += 0.0003) {
    const auto at = [&](double d) {
      return true_pixel(camera, T, options.bulge, upright ? Eigen::Vector2d(0.1, s + d) : Eigen::Vector2d(s + d, 0.1));
    };
    const Eigen::Vector2d pixel = at(0), slope = at(1e-5) - at(-1e-5);
    const int line = static_cast<int>(std::lround(pixel[along]));
    if (std::abs(pixel[along] - line) > 0.2) continue;
    const double expected = pixel[1 - along] + (line - pixel[along]) * slope[1 - along] / slope[along];
    const int middle = static_cast<int>(std::lround(expected));
    double black = 0;
    for (int i = middle - kReach_px; i <= middle + kReach_px; ++i) {
      black += 1 - (upright ? grey.at<unsigned char>(line, i) : grey.at<unsigned char>(i, line)) / 255.0;
    }
    worst = std::max(worst, std::abs(middle - kReach_px - 0.5 + black - expected));
    ++checked;
  }
  EXPECT_GT(checked, 20);
  return worst;
}

Camera camera_with(const Distortion& distortion) {
  return {320, 240, 300, 305, 155.3, 122.8, distortion};
}

TEST(RenderedPlane, HasItsEdgesWhereEveryLensProjectsThem) {
  for (const Distortion& lens : {Distortion(BrownConrady{}), Distortion(BrownConrady{-0.25, 0.08, 0.002, -0.001, 0.01}),
                                 Distortion(BrownConrady{0.5, -0.1, 0.001, 0.001, 0.02, 0.8, 0.05, 0.01}),
                                 Distortion(Fisheye{-0.03, 0.01, -0.004, 0.001})}) {
    EXPECT_LT(edge_error_px(camera_with(lens), true, {}), 0.01) << "lens " << lens.index();
    EXPECT_LT(edge_error_px(camera_with(lens), false, {}), 0.01) << "lens " << lens.index();
  }
}

TEST(RenderedPlane, BlurMovesNoEdge) {
  PlaneRenderOptions options;
  options.blur_px = 0.8;
  EXPECT_LT(edge_error_px(camera_with(BrownConrady{-0.2}), true, options), 0.01);
}

TEST(RenderedPlane, BulgesAsItsFormulaSays) {
  PlaneRenderOptions options;
  options.bulge = {{0.004, -0.003}, {0.1, 0.1}, {0.1, 0.1}};
  EXPECT_NEAR(height_m(options.bulge, {0.1, 0.1}), 0.001, 1e-15);
  EXPECT_NEAR(height_m(options.bulge, {0.2, 0.1}), -0.003, 1e-15);
  EXPECT_LT(edge_error_px(camera_with(BrownConrady{}), true, options), 0.01);
  EXPECT_LT(edge_error_px(camera_with(BrownConrady{}), false, options), 0.01);
}

// A fisheye of 200 degrees whose circle ends inside the image.
TEST(RenderedPlane, EndsWhereTheLensDoes) {
  const Camera camera{320, 240, 60, 60, 159.5, 119.5, Fisheye{}};
  const PlaneTexture white{cv::Mat(100, 100, CV_8UC1, cv::Scalar(255)), 1, {49.5, 49.5}};
  Eigen::Isometry3d T_camera_plane = Eigen::Isometry3d::Identity();
  T_camera_plane.translation().z() = 1;
  PlaneRenderOptions options;
  options.background_grey = 7;
  const cv::Mat grey = render_plane(camera, T_camera_plane, white, options);
  EXPECT_EQ(grey.at<unsigned char>(120, 160), 255);
  EXPECT_EQ(grey.at<unsigned char>(120, 160 + 85), 255);  // 81 degrees off axis, 6 m away on the plane
  EXPECT_EQ(grey.at<unsigned char>(120, 160 + 100), 7);   // 95 degrees
}

TEST(RenderedPlane, HasTheNoiseAskedFor) {
  PlaneRenderOptions options;
  options.noise_grey = 3;
  options.background_grey = 128;
  const Camera camera = camera_with(BrownConrady{});
  Eigen::Isometry3d behind = Eigen::Isometry3d::Identity();
  behind.translation().z() = -1;
  const cv::Mat grey = render_plane(camera, behind, half_plane(true), options);
  cv::Scalar mean, sigma;
  cv::meanStdDev(grey, mean, sigma);
  EXPECT_NEAR(mean[0], 128, 0.1);
  EXPECT_NEAR(sigma[0], 3, 0.1);
  EXPECT_EQ(cv::norm(grey, render_plane(camera, behind, half_plane(true), options), cv::NORM_INF), 0);
  options.seed = 2;
  EXPECT_GT(cv::norm(grey, render_plane(camera, behind, half_plane(true), options), cv::NORM_INF), 0);
}

TEST(RenderedPlane, RefusesWhatCannotBeDrawn) {
  const PlaneTexture texture = half_plane(true);
  EXPECT_THROW(PlaneRenderer(Camera{}, texture), std::invalid_argument);
  EXPECT_THROW(PlaneRenderer(camera_with(BrownConrady{}), {cv::Mat(), 1, {0, 0}}), std::invalid_argument);
  PlaneRenderOptions options;
  options.supersampling = 0;
  EXPECT_THROW(render_plane(camera_with(BrownConrady{}), tilted_pose(), texture, options), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
