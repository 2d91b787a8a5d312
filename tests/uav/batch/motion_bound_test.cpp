// SPDX-License-Identifier: Apache-2.0
#include "uav/batch/motion_bound.h"

#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/uav/flown_scene.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

Bearing look(const Eigen::Vector3d& from, double sigma_rad, Timestamp time) {
  Bearing bearing;
  bearing.origin_world = from;
  bearing.covariance = sigma_rad * sigma_rad * Eigen::Matrix2d::Identity();
  bearing.time = time;
  return bearing;
}

TargetState resting() {
  TargetState state;
  state.time = Timestamp(5s);
  return state;
}

// Each of three orthogonal lines of sight tells the two coordinates across it to sigma r = 0.1 m: the information of
// each coordinate is 2 / 0.01 per moment. Moments at -1, 0 and 1 s: position 3, velocity 2 of these.
TEST(MotionBound, IsExactForOrthogonalLinesOfSight) {
  std::vector<Bearing> looks;
  for (auto time : {4s, 5s, 6s}) {
    for (int i = 0; i < 3; ++i) looks.push_back(look(100.0 * Eigen::Vector3d::Unit(i), 1e-3, Timestamp(time)));
  }
  const auto bound = motion_bound(resting(), looks, MotionModel::Velocity);
  ASSERT_TRUE(bound);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR((*bound)(i, i), 0.01 / 6.0, 1e-9);
    EXPECT_NEAR((*bound)(3 + i, 3 + i), 0.01 / 4.0, 1e-9);
    EXPECT_EQ((*bound)(6 + i, 6 + i), 0.0);
  }
}

// The paper's eq. 12: two lines of sight at the angle γ: σ(r₁) = σ / sin γ, in the plane of the lines.
TEST(MotionBound, AgreesWithThePaperOnTwoReceivers) {
  constexpr double kGamma = 0.7, kSigma_m = 0.1;
  std::vector<Bearing> looks;
  for (int repeat = 0; repeat < 2; ++repeat) {  // the second long before: velocity takes nothing from position
    const Timestamp time(repeat == 0 ? 5s : -99995s);
    looks.push_back(look({100, 0, 0}, kSigma_m / 100, time));
    looks.push_back(look({100 * std::cos(kGamma), 100 * std::sin(kGamma), 0}, kSigma_m / 100, time));
  }
  const auto bound = motion_bound(resting(), looks, MotionModel::Velocity);
  ASSERT_TRUE(bound);
  // Along line 1 only line 2 tells: across it, at sin γ.
  const double across_one = kSigma_m * kSigma_m;
  const double along_one = across_one * (1 + std::cos(kGamma) * std::cos(kGamma)) / std::pow(std::sin(kGamma), 2);
  EXPECT_NEAR((*bound)(1, 1), across_one, 1e-6);
  EXPECT_NEAR((*bound)(0, 0), along_one, 1e-6);
}

TEST(MotionBound, IsEmptyForOneReceiver) {
  std::vector<Bearing> looks;
  for (int i = 0; i < 8; ++i) looks.push_back(look({100, 0, 0}, 1e-3, Timestamp(std::chrono::seconds(i))));
  TargetState moving = resting();
  moving.v_world = {3, 5, -2};
  EXPECT_FALSE(motion_bound(moving, looks, MotionModel::Velocity));
  EXPECT_FALSE(motion_bound(moving, looks, MotionModel::Acceleration));
}

TEST(MotionBound, IsWiderWithMoreUnknowns) {
  const TargetScene scene = make_target_scene({});
  const auto bearings = bearings_of_target(scene, 0);
  const TargetState truth = true_state(scene.paths[0], Timestamp(4s));
  const auto straight = motion_bound(truth, bearings, MotionModel::Velocity);
  const auto curved = motion_bound(truth, bearings, MotionModel::Acceleration);
  ASSERT_TRUE(straight && curved);
  EXPECT_GT((*curved)(0, 0), (*straight)(0, 0));
}

TEST(MotionBound, RefusesATargetInAReceiver) {
  const std::vector<Bearing> looks{look(Eigen::Vector3d::Zero(), 1e-3, Timestamp(5s))};
  EXPECT_THROW(motion_information(resting(), looks), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
