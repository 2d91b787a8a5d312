// SPDX-License-Identifier: Apache-2.0
#include "uav/paper/paper_geometry.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/pose.h"
#include "geometry/tangent.h"
#include "uav/target_state.h"

namespace alidade {
namespace {

using Eigen::Vector3d;

TargetState flying() {
  TargetState state;
  state.time = Timestamp(std::chrono::milliseconds(700));
  state.p_world = Vector3d(5, -3, 60);
  state.v_world = Vector3d(12, 7, -4);
  state.a_world = Vector3d(1, -2, 3);
  return state;
}

// Receivers around it at elevation 35° or as told; receiver k looks k · gap later.
std::vector<Bearing> seen(const TargetState& state, int receivers, double gap_s, double elevation_rad = 0.6155) {
  std::vector<Bearing> bearings;
  for (int k = 0; k < receivers; ++k) {
    const double azimuth = 2.0 * std::numbers::pi * k / receivers, range = 100.0 + 10.0 * k;
    Bearing bearing;
    bearing.receiver = k;
    bearing.time = state.time + from_seconds(k * gap_s);
    bearing.origin_world =
        state.p_world - range * Vector3d(std::cos(elevation_rad) * std::cos(azimuth),
                                         std::cos(elevation_rad) * std::sin(azimuth), std::sin(elevation_rad));
    bearing.direction_world = (moved_to(state, bearing.time).p_world - bearing.origin_world).normalized();
    bearing.covariance = 1e-6 * Eigen::Matrix2d::Identity();
    bearings.push_back(bearing);
  }
  return bearings;
}

void disturb(std::vector<Bearing>& bearings, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, 1e-3);
  for (Bearing& bearing : bearings) {
    const double u = normal(random), v = normal(random);
    bearing.direction_world =
        (bearing.direction_world + tangent_basis(bearing.direction_world) * Eigen::Vector2d(u, v)).normalized();
  }
}

TEST(PaperPair, MeetsAtTheTargetOnceItsMotionIsTakenOff) {
  const TargetState state = flying();
  const std::vector<Bearing> two = seen(state, 2, 0.1, 0.2);
  const auto fix = solve_pair(two[0], two[1], moved_to(state, two[1].time).p_world - state.p_world);
  ASSERT_TRUE(fix);
  EXPECT_LT((fix->p_world - state.p_world).norm(), 1e-9);
  EXPECT_NEAR(fix->r1_m, 100.0, 1e-9);
  EXPECT_NEAR(fix->residual_m2, 0.0, 1e-12);
}

TEST(PaperPair, ClosedFormIsTheLeastSquaresSolution) {
  std::mt19937_64 random(3);
  std::vector<Bearing> bearings = seen(flying(), 3, 0.2);
  disturb(bearings, random);
  const auto closed = solve_pair(bearings[0], bearings[1]);
  const auto squares = solve_conjugation(std::span(bearings).first(2), PaperMotion::Still);
  ASSERT_TRUE(closed && squares);
  EXPECT_NEAR(closed->r1_m, squares->ranges_m[0], 1e-9);
  EXPECT_NEAR(closed->r2_m, squares->ranges_m[1], 1e-9);
  EXPECT_NEAR(closed->residual_m2, squares->residual_m2, 1e-9);
  EXPECT_GT(closed->residual_m2, 0.01);
  const Eigen::Matrix3d P = squares->state.covariance.topLeftCorner<3, 3>();
  EXPECT_LT((closed->covariance_world - P).norm(), 1e-9 * P.norm());
}

TEST(PaperPair, IsEmptyForParallelLines) {
  Bearing a, b;
  b.origin_world = Vector3d(10, 0, 0);
  EXPECT_FALSE(solve_pair(a, b));
  EXPECT_FALSE(solve_pair(a, a));
  b.direction_world = Vector3d(0, 1e-5, 1).normalized();
  EXPECT_TRUE(solve_pair(a, b));
}

TEST(PaperPair, RefusesWhatIsNoDirection) {
  Bearing a, b;
  b.direction_world = Vector3d(0, 1, 1);
  EXPECT_THROW(solve_pair(a, b), std::invalid_argument);
  b.direction_world = Vector3d(0, std::nan(""), 1);
  EXPECT_THROW(solve_pair(a, b), std::invalid_argument);
  b.direction_world = Vector3d::UnitX();
  b.origin_world.x() = std::nan("");
  EXPECT_THROW(solve_pair(a, b), std::invalid_argument);
}

TEST(PaperConjugation, TellsPositionAndVelocityFromThreeReceiversAndMore) {
  TargetState state = flying();
  state.a_world.setZero();
  for (const int receivers : {3, 4, 6}) {
    const auto fix = solve_conjugation(seen(state, receivers, 0.1), PaperMotion::Velocity);
    ASSERT_TRUE(fix);
    EXPECT_LT((fix->state.p_world - state.p_world).norm(), 1e-8) << receivers;
    EXPECT_LT((fix->state.v_world - state.v_world).norm(), 1e-7) << receivers;
    EXPECT_EQ(fix->state.time, state.time);
    EXPECT_FALSE(fix->is_ill_conditioned);
    EXPECT_NEAR(fix->ranges_m[0], 100.0, 1e-8);
  }
}

TEST(PaperConjugation, TellsAnAccelerationFromFiveReceiversAndNotFromFour) {
  const TargetState state = flying();
  const auto fix = solve_conjugation(seen(state, 5, 0.2), PaperMotion::Acceleration);
  ASSERT_TRUE(fix);
  EXPECT_LT((fix->state.p_world - state.p_world).norm(), 1e-7);
  EXPECT_LT((fix->state.a_world - state.a_world).norm(), 1e-5);
  EXPECT_FALSE(solve_conjugation(seen(state, 4, 0.2), PaperMotion::Acceleration));
  EXPECT_FALSE(solve_conjugation(seen(state, 2, 0.2), PaperMotion::Velocity));
  EXPECT_FALSE(solve_conjugation(seen(state, 1, 0.2), PaperMotion::Still));
}

// Mean NEES of 6 unknowns over n runs: standard deviation √(12 / n).
TEST(PaperConjugation, CovarianceIsThatOfItsErrors) {
  std::mt19937_64 random(11);
  TargetState state = flying();
  state.a_world.setZero();
  for (const int receivers : {3, 5}) {
    constexpr int kRuns = 2000;
    double sum = 0;
    for (int run = 0; run < kRuns; ++run) {
      std::vector<Bearing> bearings = seen(state, receivers, 0.3);
      disturb(bearings, random);
      const auto fix = solve_in_two_steps(bearings, PaperMotion::Velocity);
      ASSERT_TRUE(fix);
      Vector6d error;
      error << fix->state.p_world - state.p_world, fix->state.v_world - state.v_world;
      const Matrix6d P = fix->state.covariance.topLeftCorner<6, 6>();
      sum += error.dot(P.inverse() * error);
    }
    EXPECT_NEAR(sum / kRuns, 6.0, 5.0 * std::sqrt(12.0 / kRuns)) << receivers;
  }
}

TEST(PaperConjugation, GrowsUncertainAsTheLinesOfSightComeIntoOnePlane) {
  TargetState state = flying();
  state.v_world.setZero();
  state.a_world.setZero();
  double last = 0.0;
  for (const double elevation_deg : {35.26, 10.0, 1.0}) {
    const auto fix =
        solve_conjugation(seen(state, 3, 0.1, elevation_deg * std::numbers::pi / 180), PaperMotion::Velocity);
    ASSERT_TRUE(fix);
    const double sigma = std::sqrt(fix->state.covariance.topLeftCorner<3, 3>().trace());
    EXPECT_GT(sigma, 1.5 * last) << elevation_deg;
    last = sigma;
  }
  const auto flat = solve_in_two_steps(seen(state, 3, 0.1, 0.0), PaperMotion::Velocity);
  ASSERT_TRUE(flat);
  EXPECT_TRUE(flat->is_ill_conditioned);
  EXPECT_GT(flat->condition, 1e4);
  EXPECT_GT(flat->state.covariance.trace(), 1e6);
  EXPECT_GT((flat->state.p_world - state.p_world).norm(), 1.0);  // and so it is
}

TEST(PaperConjugation, FlagsVelocityThatNoDelayTells) {
  const auto fix = solve_in_two_steps(seen(flying(), 3, 0.0), PaperMotion::Velocity);
  ASSERT_TRUE(fix);
  EXPECT_TRUE(fix->is_ill_conditioned);
  EXPECT_LT(fix->state.v_world.norm(), 1e-9);
  EXPECT_NEAR(fix->state.covariance(3, 3), 1e8, 1.0);
  EXPECT_LT((fix->state.p_world - flying().p_world).norm(), 1e-9);
}

TEST(PaperTwoSteps, SecondStepRepeatsTheFirstWhereThereAreSixEquationsInSixUnknowns) {
  std::mt19937_64 random(5);
  std::vector<Bearing> bearings = seen(flying(), 3, 0.15);
  disturb(bearings, random);
  const auto first = solve_conjugation(bearings, PaperMotion::Velocity);
  const auto both = solve_in_two_steps(bearings, PaperMotion::Velocity);
  ASSERT_TRUE(first && both);
  EXPECT_NEAR(first->residual_m2, 0.0, 1e-18);
  EXPECT_LT((first->state.p_world - both->state.p_world).norm(), 1e-8);
}

// All in one plane, with a velocity across it that A⁺ cannot tell: its range is drawn off, that of the pair is not.
TEST(PaperTwoSteps, SecondStepTakesTheRangeFromThePairWhereTheSystemIsSingular) {
  TargetState state = flying();
  state.v_world = Vector3d(12, 7, 0);
  state.a_world.setZero();
  const std::vector<Bearing> flat = seen(state, 3, 0.1, 0.0);
  const auto both = solve_in_two_steps(flat, PaperMotion::Velocity);
  ASSERT_TRUE(both && both->is_ill_conditioned);
  const double dt = 0.1;
  const auto pair = solve_pair(flat[0], flat[1], dt * both->state.v_world);
  ASSERT_TRUE(pair);
  EXPECT_LT((both->state.p_world - pair->p_world).norm(), 1e-12);
  EXPECT_EQ(both->ranges_m[1], pair->r2_m);
}

}  // namespace
}  // namespace alidade
