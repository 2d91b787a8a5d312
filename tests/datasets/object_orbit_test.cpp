// SPDX-License-Identifier: Apache-2.0
#include "datasets/object_orbit.h"

#include <cmath>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace alidade {
namespace {

constexpr unsigned kSeed = 89;
constexpr OrbitPath kPaths[] = {OrbitPath::Smooth, OrbitPath::Turn, OrbitPath::StopAndGo};

double length_m(const std::vector<Eigen::Isometry3d>& poses) {
  double sum = 0.0;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    sum += (poses[k].translation() - poses[k - 1].translation()).norm();
  }
  return sum;
}

// mm per frame², over frames and the three axes.
double rms_acceleration_mm(const std::vector<Eigen::Isometry3d>& poses) {
  double sum = 0.0;
  for (std::size_t k = 1; k + 1 < poses.size(); ++k) {
    sum +=
        (poses[k + 1].translation() - 2 * poses[k].translation() + poses[k - 1].translation()).squaredNorm() * 1e6 / 3;
  }
  return std::sqrt(sum / static_cast<double>(poses.size() - 2));
}

// The figures of docs: camera-tracker paper, "what measurement showed".
TEST(OrbitPoses, AreTheSmoothPath) {
  const auto poses = orbit_poses(OrbitPath::Smooth, 55);
  ASSERT_EQ(poses.size(), 55u);
  EXPECT_NEAR(length_m(poses), 1.078, 5e-4);
  EXPECT_NEAR(rms_acceleration_mm(poses), 1.54, 5e-3);
}

TEST(OrbitPoses, AreTheTurn) {
  const auto poses = orbit_poses(OrbitPath::Turn, 55);
  EXPECT_NEAR(length_m(poses), 1.037, 5e-4);
  EXPECT_NEAR(rms_acceleration_mm(poses), 0.905, 5e-4);
}

// Elevation 12° at both ends, azimuth -50° to 50°, 0.6 m; for the turn 0.3 + 0.33 (√1.02 - √0.02) m.
TEST(OrbitPoses, BeginAndEndWhereTheyShould) {
  const double elevation = 12 * std::numbers::pi / 180, azimuth = 50 * std::numbers::pi / 180;
  const Eigen::Vector3d end(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                            std::cos(elevation) * std::cos(azimuth));
  const Eigen::Vector3d start(-end.x(), end.y(), end.z());
  for (const OrbitPath path : kPaths) {
    const double distance_m = path == OrbitPath::Turn ? 0.3 + 0.33 * (std::sqrt(1.02) - std::sqrt(0.02)) : 0.6;
    const auto poses = orbit_poses(path, 30);
    EXPECT_LT((poses.front().translation() - distance_m * start).norm(), 1e-12) << static_cast<int>(path);
    EXPECT_LT((poses.back().translation() - distance_m * end).norm(), 1e-12) << static_cast<int>(path);
  }
}

TEST(OrbitPoses, AreRotationsThatRollAboutTheLineOfSight) {
  for (const OrbitPath path : kPaths) {
    for (const Eigen::Isometry3d& T : orbit_poses(path, 55)) {
      EXPECT_LT((T.linear().transpose() * T.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
      EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-12);
      // The axis passes the origin at no more than the target's √2 · 12 mm.
      EXPECT_LT(T.linear().col(2).cross(-T.translation()).norm(), 0.017);
    }
  }
  // At the start the roll is 18° sin 0.4 about the target (0, 12, 0) mm, the world's y up.
  const Eigen::Isometry3d T = orbit_poses(OrbitPath::Smooth, 55).front();
  const double roll = 18 * std::numbers::pi / 180 * std::sin(0.4);
  EXPECT_LT((T.linear().col(2) - (Eigen::Vector3d(0, 0.012, 0) - T.translation()).normalized()).norm(), 1e-12);
  EXPECT_NEAR(T.linear()(1, 0), std::tan(roll) * T.linear()(1, 1), 1e-12);
  EXPECT_LT(T.linear()(1, 1), -0.9);
}

TEST(OrbitPoses, KeepTheObjectInTheImage) {
  const Camera camera = orbit_camera();
  const auto points = orbit_object();
  for (const OrbitPath path : kPaths) {
    for (const Eigen::Isometry3d& T : orbit_poses(path, 55)) {
      for (const Eigen::Vector3d& p : points) {
        const auto projection = project(camera, T.inverse() * p);
        ASSERT_TRUE(projection);
        EXPECT_TRUE(is_inside(camera, projection->pixel)) << static_cast<int>(path);
      }
    }
  }
}

// Three legs of 10 frames each on the smooth path, and 6 frames of rest between them.
TEST(OrbitPoses, RestInBetween) {
  const auto poses = orbit_poses(OrbitPath::StopAndGo, 43);
  const auto stops = orbit_poses(OrbitPath::Smooth, 4);
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const double moved_m = (poses[k].translation() - poses[k - 1].translation()).norm();
    if ((k - 1) % 16 < 10) {
      EXPECT_GT(moved_m, 1e-3) << k;
    } else {
      EXPECT_LT(moved_m, 1e-12) << k;
    }
  }
  for (std::size_t leg = 0; leg < 3; ++leg) {
    EXPECT_LT((poses[16 * leg].matrix() - stops[leg].matrix()).norm(), 1e-12) << leg;
    EXPECT_LT((poses[16 * leg + 10].matrix() - stops[leg + 1].matrix()).norm(), 1e-12) << leg;
  }
}

TEST(OrbitObject, IsFifteenCentimetresOfManyPoints) {
  const auto points = orbit_object();
  ASSERT_EQ(points.size(), 453u);
  Eigen::Vector3d low = points.front(), high = points.front();
  for (const Eigen::Vector3d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  EXPECT_NEAR((high - low).maxCoeff(), 0.15, 1e-12);
  EXPECT_LT((high + low).norm(), 1e-12);
  EXPECT_GT((high - low).minCoeff(), 0.08);  // a body, no disc
}

TEST(FitPoints, CentresAndScalesThem) {
  const auto points = fitted_to(2.0, {{1, 1, 1}, {5, 2, 1}, {3, 1, 2}});
  ASSERT_EQ(points.size(), 3u);
  EXPECT_LT((points[0] - Eigen::Vector3d(-1, -0.25, -0.25)).norm(), 1e-12);
  EXPECT_LT((points[1] - Eigen::Vector3d(1, 0.25, -0.25)).norm(), 1e-12);
  EXPECT_LT((points[2] - Eigen::Vector3d(0, -0.25, 0.25)).norm(), 1e-12);
  EXPECT_TRUE(fitted_to(2.0, {}).empty());
  EXPECT_EQ(fitted_to(2.0, {{1, 1, 1}, {1, 1, 1}})[1], Eigen::Vector3d(1, 1, 1));
}

// 2 · 453 · 55 draws: their standard deviation is known to 0.32 %, their mean to 0.45 % of it.
TEST(SightOrbitObject, AddsTheNoiseItIsTold) {
  const Camera camera = orbit_camera();
  const auto points = orbit_object();
  std::mt19937_64 random(kSeed);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double squares = 0.0, count = 0.0;
  for (const Eigen::Isometry3d& T : orbit_poses(OrbitPath::Smooth, 55)) {
    const auto observations = sighted(camera, T, points, 3.0, random);
    ASSERT_EQ(observations.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(observations[i].p_world, points[i]);
      EXPECT_EQ(observations[i].sigma_px, 1.0);
      const Eigen::Vector2d off = observations[i].pixel - project(camera, T.inverse() * points[i])->pixel;
      sum += off;
      squares += off.squaredNorm();
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / (2 * count)), 3.0, 0.04) << "seed " << kSeed;
  EXPECT_LT(sum.norm() / count, 0.08) << "seed " << kSeed;
}

// Of 453 · 20 sightings a share of 0.3 ± 0.005.
TEST(SightOrbitObject, ScattersAShareOverTheImage) {
  const Camera camera = orbit_camera();
  const auto points = orbit_object();
  const auto T = orbit_poses(OrbitPath::Smooth, 2).front();
  std::mt19937_64 random(kSeed);
  double changed = 0.0, left = 0.0;
  for (int trial = 0; trial < 20; ++trial) {
    const auto exact = sighted(camera, T, points, 0.0, random);
    const auto scattered = with_outliers(camera, exact, 0.3, random);
    for (std::size_t i = 0; i < exact.size(); ++i) {
      EXPECT_EQ(scattered[i].p_world, exact[i].p_world);
      if (scattered[i].pixel == exact[i].pixel) continue;
      ++changed;
      EXPECT_TRUE(is_inside(camera, scattered[i].pixel, -0.5));
      if (scattered[i].pixel.x() < camera.width / 2.0) ++left;
    }
  }
  EXPECT_NEAR(changed / (453 * 20), 0.3, 0.02) << "seed " << kSeed;
  EXPECT_NEAR(left / changed, 0.5, 0.04) << "seed " << kSeed;
}

}  // namespace
}  // namespace alidade
