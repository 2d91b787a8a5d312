// SPDX-License-Identifier: Apache-2.0
#include "reconstruction/bundle_covariance.h"

#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/support/synthetic_scene.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 47;

// Two fixed keyframes, two free ones, thirty points; pixels drawn anew in every trial, then adjusted.
TEST(BundleCovariance, IsAsLargeAsTheErrorsOfAdjustedMaps) {
  const Camera camera = test::vga_camera();
  test::RandomGeometry random(kSeed);
  const PointMap truth = test::make_map(camera, 30, 4, 0.0, random);
  BundleOptions options = global_bundle_options(truth, 2);
  options.loss_sigmas = 100;  // plain least squares: the covariance is that of no robust estimate
  constexpr int kTrials = 150;
  double pose_sum = 0, point_sum = 0;
  int points = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    PointMap map = truth;
    for (Keyframe& keyframe : map.keyframes) {
      for (Sighting& s : keyframe.sightings) {
        s.sigma_px = 0.5;
        s.pixel += Eigen::Vector2d(random.normal(0.5), random.normal(0.5));
      }
    }
    const PointMap found = with_covariances(camera, adjust_bundle(camera, map, options).map, options);
    for (std::size_t k = 2; k < 4; ++k) {
      const Keyframe& keyframe = found.keyframes[k];
      const Vector6d error = difference(keyframe.T_world_camera, truth.keyframes[k].T_world_camera);
      pose_sum += error.dot(keyframe.covariance.ldlt().solve(error));
    }
    for (std::size_t i = 0; i < found.points.size(); ++i) {
      if (found.points[i].covariance_world.isZero()) continue;  // seen too rarely
      const Eigen::Vector3d error = found.points[i].p_world - truth.points[i].p_world;
      point_sum += error.dot(found.points[i].covariance_world.ldlt().solve(error));
      ++points;
    }
  }
  ASSERT_GT(points, 25 * kTrials);
  // Of a single pose the mean has variance 12/150; the two of a trial are correlated, at worst fully.
  EXPECT_NEAR(pose_sum / (2 * kTrials), 6.0, 3.3 * std::sqrt(12.0 / kTrials)) << "seed " << kSeed;
  EXPECT_NEAR(point_sum / points, 3.0, 0.4) << "seed " << kSeed;
}

// The Schur complement against the inverse of the whole matrix J'J, by central differences over poses and points.
TEST(BundleCovariance, IsTheInverseOfTheWholeNormalMatrix) {
  const Camera camera = test::vga_camera();
  test::RandomGeometry random(kSeed);
  const PointMap map = test::make_map(camera, 12, 4, 0.0, random);
  const BundleOptions options = global_bundle_options(map, 2);
  const auto moved = [&map](const Eigen::VectorXd& x) {
    PointMap m = map;
    for (std::size_t k = 2; k < 4; ++k) {
      m.keyframes[k].T_world_camera =
          m.keyframes[k].T_world_camera * perturbation(x.segment<6>(6 * static_cast<Eigen::Index>(k - 2)));
    }
    for (std::size_t i = 0; i < m.points.size(); ++i) {
      m.points[i].p_world += x.segment<3>(12 + 3 * static_cast<Eigen::Index>(i));
    }
    return m;
  };
  const auto pixels = [&camera](const PointMap& m) {
    std::vector<double> values;
    for (const Keyframe& keyframe : m.keyframes) {
      for (const Sighting& s : keyframe.sightings) {
        const Eigen::Vector3d& p_world = m.points[static_cast<std::size_t>(s.point)].p_world;
        const Eigen::Vector2d pixel = project(camera, keyframe.T_world_camera.inverse() * p_world)->pixel;
        values.insert(values.end(), {pixel.x(), pixel.y()});
      }
    }
    return Eigen::VectorXd(Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  };
  constexpr Eigen::Index kSize = 12 + 36;
  Eigen::MatrixXd J(pixels(map).size(), kSize);
  for (Eigen::Index i = 0; i < kSize; ++i) {
    const Eigen::VectorXd step = 1e-6 * Eigen::VectorXd::Unit(kSize, i);
    J.col(i) = (pixels(moved(step)) - pixels(moved(-step))) / 2e-6;
  }
  const Eigen::MatrixXd C = (J.transpose() * J).ldlt().solve(Eigen::MatrixXd::Identity(kSize, kSize));
  const PointMap found = with_covariances(camera, map, options);
  for (Eigen::Index k = 0; k < 2; ++k) {
    const Matrix6d expected = C.block<6, 6>(6 * k, 6 * k);
    const Matrix6d& covariance = found.keyframes[static_cast<std::size_t>(k) + 2].covariance;
    EXPECT_LT((covariance - expected).norm(), 1e-4 * expected.norm()) << "keyframe " << k + 2;
  }
  for (Eigen::Index i = 0; i < 12; ++i) {
    const Eigen::Matrix3d expected = C.block<3, 3>(12 + 3 * i, 12 + 3 * i);
    const Eigen::Matrix3d& covariance = found.points[static_cast<std::size_t>(i)].covariance_world;
    EXPECT_LT((covariance - expected).norm(), 1e-4 * expected.norm()) << "point " << i;
  }
  EXPECT_TRUE(found.keyframes[0].covariance.isZero());
}

// With one fixed keyframe the distance to the farthest is certain, and all else finite.
TEST(BundleCovariance, HoldsTheScaleOfAFreeGauge) {
  const Camera camera = test::vga_camera();
  test::RandomGeometry random(kSeed);
  const PointMap map = test::make_map(camera, 30, 4, 0.0, random);
  const PointMap found = with_covariances(camera, map, global_bundle_options(map, 1));
  const Keyframe& last = found.keyframes[3];
  const Eigen::Vector3d along =
      (last.T_world_camera.inverse() * map.keyframes[0].T_world_camera.translation()).normalized();
  const Eigen::Matrix3d C = last.covariance.topLeftCorner<3, 3>();
  EXPECT_LT(std::sqrt(along.dot(C * along)), 1e-5);
  EXPECT_GT(std::sqrt(C.trace()), 1e-3);
  EXPECT_LT(std::sqrt(C.trace()), 0.1);
}

TEST(BundleCovariance, LeavesWhatTheBundleDoesNotHold) {
  const Camera camera = test::vga_camera();
  test::RandomGeometry random(kSeed);
  PointMap map = test::make_map(camera, 30, 4, 0.0, random);
  map.points[5].covariance_world = 7 * Eigen::Matrix3d::Identity();
  for (std::size_t k = 1; k < 4; ++k)
    std::erase_if(map.keyframes[k].sightings, [](const Sighting& s) { return s.point == 5; });
  const PointMap found = with_covariances(camera, map, global_bundle_options(map, 2));
  EXPECT_EQ(found.points[5].covariance_world, map.points[5].covariance_world);
}

}  // namespace
}  // namespace alidade
