// SPDX-License-Identifier: Apache-2.0
#include "marker1d/paper_motion.h"

#include <gtest/gtest.h>

#include "geometry/pose.h"
#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 17;

Timestamp at(double t) {
  return Timestamp(from_seconds(t));
}

// A parabola in place, and turns about one axis by a parabola in angle.
Eigen::Isometry3d accelerated(double t) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3((0.3 + 2 * t - 5 * t * t) * Eigen::Vector3d(1, 2, -1).normalized());
  T.translation() = Eigen::Vector3d(1, 2, 3) + t * Eigen::Vector3d(0.5, -1, 0) + t * t * Eigen::Vector3d(3, 0, -4);
  return T;
}

TEST(PaperMotion, GoesOnWithVelocityAndAcceleration) {
  for (const int memory : {3, 10}) {
    PaperMotion motion(memory);
    for (const double t : {0.0, 0.004, 0.008, 0.0121, 0.016}) motion.add(at(t), accelerated(t));
    for (const double t : {0.02, 0.1, -0.1}) {
      EXPECT_LT(difference(accelerated(t), motion.pose_at(at(t))).norm(), 1e-9) << t;
    }
  }
}

TEST(PaperMotion, GoesBackwardAlike) {
  PaperMotion motion(3);
  for (const double t : {0.02, 0.016, 0.012}) motion.add(at(t), accelerated(t));
  EXPECT_LT(difference(accelerated(0.0), motion.pose_at(at(0.0))).norm(), 1e-9);
}

TEST(PaperMotion, KnowsLessFromFewerPoses) {
  PaperMotion motion(5);
  EXPECT_TRUE(motion.is_empty());
  EXPECT_THROW(motion.pose_at(at(0)), std::invalid_argument);
  EXPECT_THROW(motion.point_at(at(0), {0, 0, 0}), std::invalid_argument);
  motion.add(at(0.0), accelerated(0.0));
  EXPECT_LT(difference(accelerated(0.0), motion.pose_at(at(0.5))).norm(), 1e-12);
  motion.add(at(0.1), accelerated(0.1));
  const Eigen::Isometry3d line = interpolate(accelerated(0.0), accelerated(0.1), 2.0);
  EXPECT_LT(difference(line, motion.pose_at(at(0.2))).norm(), 1e-12);
  motion.add(at(0.1), accelerated(0.0));  // in place of the last one
  EXPECT_LT(difference(accelerated(0.0), motion.pose_at(at(0.2))).norm(), 1e-12);
}

TEST(PaperMotion, PointsMoveOnParabolasOfTheirOwn) {
  PaperMotion motion(3);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (const double t : {0.0, 0.1, 0.2}) {
    T.translation() = Eigen::Vector3d(t * t, t, 1);
    motion.add(at(t), T);
  }
  EXPECT_LT((motion.point_at(at(0.4), {1, 1, 1}) - Eigen::Vector3d(1.16, 1.4, 2)).norm(), 1e-12);
}

TEST(PaperMotion, ManyPosesAverageTheirNoise) {
  test::RandomGeometry random(kSeed);
  double squares[2] = {0, 0};
  for (int trial = 0; trial < 200; ++trial) {
    PaperMotion short_memory(3), long_memory(30);
    for (int i = 0; i < 30; ++i) {
      Eigen::Isometry3d T = accelerated(0.004 * i);
      T.translation() += random.vector(1e-4);
      short_memory.add(at(0.004 * i), T);
      long_memory.add(at(0.004 * i), T);
    }
    const Eigen::Vector3d truth = accelerated(0.16).translation();
    squares[0] += (short_memory.pose_at(at(0.16)).translation() - truth).squaredNorm();
    squares[1] += (long_memory.pose_at(at(0.16)).translation() - truth).squaredNorm();
  }
  EXPECT_GT(std::sqrt(squares[0] / squares[1]), 20.0) << "seed " << kSeed;
}

}  // namespace
}  // namespace alidade
