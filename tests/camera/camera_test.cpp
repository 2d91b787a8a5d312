// SPDX-License-Identifier: Apache-2.0
#include "camera/camera.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

namespace alidade {
namespace {

// Without distortion; barrel, as of a webcam; the colour camera of TUM fr1, whose k2 and k3 fight each other; strong
// barrel with tangential parts, which folds back outside the image.
const std::vector<Camera> kCameras{
    {640, 480, 500, 510, 320, 240, {}},
    {640, 480, 518.8, 518.8, 320, 240, BrownConrady{-0.0308, 0, 0, 0, 0}},
    {640, 480, 517.3, 516.5, 318.6, 255.3, BrownConrady{0.2624, -0.9531, -0.0054, 0.0026, 1.1633}},
    {752, 480, 458.654, 457.296, 367.215, 248.375,
     BrownConrady{-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05, 0}},
};

std::vector<Eigen::Vector3d> points_in_view(const Camera& camera) {
  std::vector<Eigen::Vector3d> points;
  for (double z : {0.5, 3.0, 40.0}) {
    for (int i = -4; i <= 4; ++i) {
      for (int j = -4; j <= 4; ++j) {
        points.emplace_back(z * 0.12 * i * camera.width / camera.fx, z * 0.12 * j * camera.height / camera.fy, z);
      }
    }
  }
  return points;
}

TEST(Project, AgreesWithOpenCv) {
  for (const Camera& camera : kCameras) {
    const auto& k = std::get<BrownConrady>(camera.distortion);
    const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    for (const Eigen::Vector3d& p : points_in_view(camera)) {
      std::vector<cv::Point2d> expected;
      cv::projectPoints(std::vector<cv::Point3d>{{p.x(), p.y(), p.z()}}, cv::Vec3d(), cv::Vec3d(), K,
                        std::vector<double>{k.k1, k.k2, k.p1, k.p2, k.k3}, expected);
      const auto found = project(camera, p);
      ASSERT_TRUE(found) << p.transpose();
      EXPECT_LT((found->pixel - Eigen::Vector2d(expected[0].x, expected[0].y)).norm(), 1e-9) << p.transpose();
    }
  }
}

TEST(Project, HasTheJacobianOfCentralDifferences) {
  for (const Camera& camera : kCameras) {
    for (const Eigen::Vector3d& p : points_in_view(camera)) {
      const double h = 1e-6 * p.z();
      Eigen::Matrix<double, 2, 3> J;
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
        J.col(i) = (project(camera, p + step)->pixel - project(camera, p - step)->pixel) / (2 * h);
      }
      const auto found = project(camera, p);
      EXPECT_LT((found->J_pixel_point - J).norm(), 1e-6 * J.norm()) << p.transpose();
    }
  }
}

TEST(Project, IsEmptyBehindTheCamera) {
  for (const Camera& camera : kCameras) {
    EXPECT_FALSE(project(camera, {0.1, 0.1, -1}));
    EXPECT_FALSE(project(camera, {0.1, 0.1, 0}));
    EXPECT_FALSE(project(camera, {0, 0, std::nan("")}));
  }
}

// r (1 + k1 r²) with k1 = -0.25 grows until 1 + 3 k1 r² = 0: r² = 4/3.
TEST(Project, IsEmptyWhereTheDistortionFoldsBack) {
  Camera camera = kCameras[0];
  auto& lens = std::get<BrownConrady>(camera.distortion);
  lens.k1 = -0.25;
  const double fold = std::sqrt(4.0 / 3.0);
  EXPECT_TRUE(project(camera, {0.999 * fold, 0, 1}));
  EXPECT_FALSE(project(camera, {1.001 * fold, 0, 1}));
  EXPECT_FALSE(project(camera, {50, 0, 1}));
}

// The slope 1 + 3 k1 s + 5 k2 s² dips below 0 in a narrow interval about s = 1 only, and is positive again beyond it.
TEST(Project, IsEmptyBeyondANarrowFold) {
  Camera camera = kCameras[0];
  auto& lens = std::get<BrownConrady>(camera.distortion);
  lens.k1 = -2.0 * 1.0001 / 3.0;
  lens.k2 = 1.0 / 5.0;
  EXPECT_TRUE(project(camera, {0.98, 0, 1}));
  EXPECT_FALSE(project(camera, {1.02, 0, 1}));
  EXPECT_FALSE(project(camera, {2.0, 0, 1}));
}

// The same with a cubic slope: (1 - s)² (1 + s) less a little = 1 - s - s² + s³ - 0.0001 s.
TEST(Project, IsEmptyBeyondANarrowFoldOfThreeCoefficients) {
  Camera camera = kCameras[0];
  auto& lens = std::get<BrownConrady>(camera.distortion);
  lens.k1 = -1.0001 / 3.0;
  lens.k2 = -1.0 / 5.0;
  lens.k3 = 1.0 / 7.0;
  EXPECT_TRUE(project(camera, {0.98, 0, 1}));
  EXPECT_FALSE(project(camera, {1.02, 0, 1}));
}

TEST(Unproject, GivesBackTheDirectionOfTheProjectedPoint) {
  for (const Camera& camera : kCameras) {
    for (const Eigen::Vector3d& p : points_in_view(camera)) {
      const auto direction = unproject(camera, project(camera, p)->pixel);
      ASSERT_TRUE(direction) << p.transpose();
      EXPECT_LT((*direction - p.normalized()).norm(), 1e-9) << p.transpose();
    }
  }
}

TEST(Unproject, IsUnitLengthAndAlongTheAxisAtThePrincipalPoint) {
  for (const Camera& camera : kCameras) {
    const auto direction = unproject(camera, {camera.cx, camera.cy});
    ASSERT_TRUE(direction);
    EXPECT_LT((*direction - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  }
}

TEST(Undistort, IsEmptyWhereNoDirectionHasThePixel) {
  Camera camera = kCameras[0];
  auto& lens = std::get<BrownConrady>(camera.distortion);
  lens.k1 = -0.25;  // no direction lies farther out than fold (1 - 0.25 fold²) = 0.77 focal lengths
  EXPECT_TRUE(undistort(camera, {camera.cx + 0.76 * camera.fx, camera.cy}));
  EXPECT_FALSE(undistort(camera, {camera.cx + 0.78 * camera.fx, camera.cy}));
}

TEST(FindFault, NamesValueAndBound) {
  const auto fault_of = [](auto change) {
    Camera camera = kCameras[1];
    change(camera);
    return find_fault(camera).value_or("none");
  };
  EXPECT_EQ(fault_of([](Camera&) {}), "none");
  EXPECT_EQ(fault_of([](Camera& c) { c.width = 0; }), "image size must be > 0 px, got 0x480");
  EXPECT_EQ(fault_of([](Camera& c) { c.fx = -3.1; }), "fx must be > 0 px, got -3.1");
  EXPECT_EQ(fault_of([](Camera& c) { c.fy = std::nan(""); }), "fy must be > 0 px, got nan");
  EXPECT_EQ(fault_of([](Camera& c) { c.fy = std::numeric_limits<double>::infinity(); }), "fy must be > 0 px, got inf");
  EXPECT_EQ(fault_of([](Camera& c) { c.cx = 641; }), "cx must lie in the image (0..640 px), got 641");
  EXPECT_EQ(fault_of([](Camera& c) { c.cy = -2; }), "cy must lie in the image (0..480 px), got -2");
  EXPECT_EQ(fault_of([](Camera& c) { std::get<BrownConrady>(c.distortion).k3 = std::nan(""); }),
            "distortion must be finite, got nan");
}

TEST(CalibrationMatrix, TakesNormalisedCoordinatesToPixels) {
  const Camera& camera = kCameras[0];
  const Eigen::Vector3d p(0.3, -0.2, 2.0);
  EXPECT_LT(((calibration_matrix(camera) * p).hnormalized() - project(camera, p)->pixel).norm(), 1e-12);
}

TEST(IsInside, CountsFromThePixelCentres) {
  const Camera& camera = kCameras[0];
  EXPECT_TRUE(is_inside(camera, {0, 0}));
  EXPECT_TRUE(is_inside(camera, {639, 479}));
  EXPECT_FALSE(is_inside(camera, {-0.1, 10}));
  EXPECT_FALSE(is_inside(camera, {639.1, 10}));
  EXPECT_FALSE(is_inside(camera, {9.9, 100}, 10));
  EXPECT_FALSE(is_inside(camera, {std::nan(""), 10}));
}

// Pixel u of the image covers [u - ½, u + ½]; halving the image maps u to (u + ½) / 2 - ½.
TEST(Resized, SeesTheSamePointAtTheResizedPixel) {
  for (const Camera& camera : kCameras) {
    const Camera half = resized(camera, 0.5);
    EXPECT_EQ(half.width, camera.width / 2);
    EXPECT_EQ(half.height, camera.height / 2);
    for (const Eigen::Vector3d& p : points_in_view(camera)) {
      const Eigen::Vector2d expected =
          (project(camera, p)->pixel.array() + 0.5).matrix() * 0.5 - Eigen::Vector2d::Constant(0.5);
      EXPECT_LT((project(half, p)->pixel - expected).norm(), 1e-9);
    }
  }
}

TEST(Resized, IsUndoneByTheInverseFactor) {
  const Camera back = resized(resized(kCameras[2], 0.25), 4.0);
  EXPECT_EQ(back.width, 640);
  EXPECT_NEAR(back.cx, kCameras[2].cx, 1e-12);
  EXPECT_EQ(back.distortion, kCameras[2].distortion);
}

}  // namespace
}  // namespace alidade
