// SPDX-License-Identifier: Apache-2.0
#include "uav/batch/placement.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "geometry/tangent.h"
#include "tests/uav/flown_scene.h"

namespace alidade {
namespace {

std::vector<Receiver> three_receivers() {
  TargetSceneOptions options;
  options.targets = 1;
  return make_target_scene(options).receivers;
}

Eigen::Vector3d middle_of(const std::vector<Receiver>& receivers) {
  return receivers[0].T_world_receiver * Eigen::Vector3d(0, 0, 120);
}

PlacementOptions options_about(const Eigen::Vector3d& middle) {
  PlacementOptions options;
  options.least_world = middle - Eigen::Vector3d(30, 20, 10);
  options.greatest_world = middle + Eigen::Vector3d(30, 20, 10);
  options.step_m = 20.0;
  options.delays_s = {0.0, 0.1, 0.2};
  return options;
}

TEST(Placement, RunsAlongXFirst) {
  const auto receivers = three_receivers();
  const PlacementOptions options = options_about(middle_of(receivers));
  const PlacementMap map = map_placement(receivers, options);
  EXPECT_EQ(map.counts, (std::array<int, 3>{4, 3, 2}));
  ASSERT_EQ(map.points.size(), 24u);
  EXPECT_TRUE(map.points[0].p_world.isApprox(options.least_world));
  EXPECT_TRUE(map.points[1].p_world.isApprox(options.least_world + Eigen::Vector3d(20, 0, 0)));
  EXPECT_TRUE(map.points[4].p_world.isApprox(options.least_world + Eigen::Vector3d(0, 20, 0)));
  EXPECT_TRUE(map.points[12].p_world.isApprox(options.least_world + Eigen::Vector3d(0, 0, 20)));
  for (const PlacementPoint& point : map.points) {
    EXPECT_EQ(point.receivers, 3);
    ASSERT_TRUE(point.rms_m);
  }
}

// 400 runs of a three-dimensional error: the RMS of them scatters by about 2.5 %.
TEST(Placement, SaysWhatTheFitReaches) {
  const auto receivers = three_receivers();
  const Eigen::Vector3d place = middle_of(receivers) + Eigen::Vector3d(15, -10, 5);
  const PlacementOptions options = options_about(place);
  const std::vector<Bearing> exact = planned_bearings(receivers, options, place);
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  double squared = 0.0;
  constexpr int kRuns = 400;
  for (int run = 0; run < kRuns; ++run) {
    auto bearings = exact;
    for (Bearing& bearing : bearings) {
      const Eigen::Vector2d error =
          std::sqrt(bearing.covariance(0, 0)) * Eigen::Vector2d(normal(random), normal(random));
      bearing.direction_world = (bearing.direction_world + tangent_basis(bearing.direction_world) * error).normalized();
    }
    squared += (fit_motion(bearings).fit->state.p_world - place).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(squared / kRuns) / *bound_at(receivers, options, place).rms_m, 1.0, 0.08);
}

TEST(Placement, IsUndeterminedWithOneReceiver) {
  auto receivers = three_receivers();
  receivers.resize(1);
  const PlacementOptions options = options_about(middle_of(receivers));
  const PlacementPoint point = bound_at(receivers, options, middle_of(receivers));
  EXPECT_EQ(point.receivers, 1);
  EXPECT_FALSE(point.rms_m);
  EXPECT_FALSE(bound_at({}, options, middle_of(receivers)).rms_m);
}

TEST(Placement, CountsOnlyCamerasThatSeeIt) {
  auto receivers = three_receivers();
  for (Receiver& receiver : receivers) {
    receiver.camera = Camera{1000, 1000, 1000, 1000, 499.5, 499.5, BrownConrady{}, 0.0};
    receiver.sigma = 1.0;
  }
  const Eigen::Vector3d middle = middle_of(receivers);
  PlacementOptions options = options_about(middle);
  options.v_world.setZero();
  EXPECT_EQ(bound_at(receivers, options, middle).receivers, 3);
  const Eigen::Vector3d behind_first = receivers[0].T_world_receiver * Eigen::Vector3d(0, 0, -20);
  EXPECT_LT(bound_at(receivers, options, behind_first).receivers, 3);
}

TEST(Placement, ImprovesWithMorePeriods) {
  const auto receivers = three_receivers();
  const Eigen::Vector3d middle = middle_of(receivers);
  PlacementOptions options = options_about(middle);
  const double of_five = *bound_at(receivers, options, middle).rms_m;
  options.periods = 10;
  EXPECT_LT(*bound_at(receivers, options, middle).rms_m, of_five);
}

TEST(Placement, NamesABadOption) {
  PlacementOptions options;
  options.step_m = 0.0;
  EXPECT_THROW(validate(options), std::invalid_argument);
  options = {};
  options.greatest_world.x() = -500.0;
  EXPECT_THROW(map_placement({}, options), std::invalid_argument);
  options = {};
  options.step_m = 1e-3;
  EXPECT_THROW(validate(options), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
