// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/bearing_filter.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "geometry/tangent.h"

namespace alidade {
namespace {

using Eigen::Vector3d;

constexpr double kSigma_rad = 1e-3;

Timestamp at(double seconds) {
  return Timestamp(from_seconds(seconds));
}

TargetState unsure_state(double position_m, double speed_m_s) {
  TargetState state;
  state.p_world = {10, 20, 100};
  state.v_world = {5, -3, 1};
  state.covariance.diagonal().head<3>().setConstant(position_m * position_m);
  state.covariance.diagonal().segment<3>(3).setConstant(speed_m_s * speed_m_s);
  return state;
}

Bearing bearing_of(const Vector3d& p_world, const Vector3d& origin, double time_s, std::mt19937_64* random = nullptr) {
  Bearing bearing;
  bearing.time = at(time_s);
  bearing.origin_world = origin;
  bearing.covariance = kSigma_rad * kSigma_rad * Eigen::Matrix2d::Identity();
  bearing.direction_world = (p_world - origin).normalized();
  if (!random) return bearing;
  std::normal_distribution<double> normal(0.0, kSigma_rad);
  const Eigen::Vector2d error(normal(*random), normal(*random));
  bearing.direction_world = (bearing.direction_world + tangent_basis(bearing.direction_world) * error).normalized();
  return bearing;
}

// The expected residual is where the state is seen from the bearing: its derivative by central differences.
TEST(BearingInnovation, HasTheDerivativeOfItsResidual) {
  const TargetState state = unsure_state(1, 1);
  const Bearing bearing = bearing_of(state.p_world + Vector3d(4, -3, 2), {-80, 30, 5}, 0);
  const auto innovation = innovation_of(state, bearing);
  ASSERT_TRUE(innovation);
  constexpr double kStep = 1e-4;
  for (int axis = 0; axis < 3; ++axis) {
    TargetState ahead = state, behind = state;
    ahead.p_world(axis) += kStep;
    behind.p_world(axis) -= kStep;
    const Eigen::Vector2d slope =
        (innovation_of(ahead, bearing)->residual - innovation_of(behind, bearing)->residual) / (2 * kStep);
    EXPECT_LT((slope - innovation->J_residual_p.col(axis)).norm(), 1e-10);
  }
}

TEST(BearingInnovation, IsEmptyBehindTheReceiver) {
  const TargetState state = unsure_state(1, 1);
  Bearing bearing = bearing_of(state.p_world, Vector3d::Zero(), 0);
  EXPECT_TRUE(innovation_of(state, bearing));
  bearing.direction_world = -bearing.direction_world;
  EXPECT_FALSE(innovation_of(state, bearing));
  bearing.origin_world = state.p_world;
  EXPECT_FALSE(innovation_of(state, bearing));
}

TEST(BearingInnovation, KnowsWhatIsAddedToTheNoise) {
  const TargetState state = unsure_state(0.01, 1);
  const Bearing bearing = bearing_of(state.p_world, Vector3d::Zero(), 0);
  const auto plain = innovation_of(state, bearing), added = innovation_of(state, bearing, 2e-3);
  EXPECT_TRUE((added->covariance - plain->covariance).isApprox(4e-6 * Eigen::Matrix2d::Identity(), 1e-9));
  EXPECT_LT(added->log_density, plain->log_density);
}

// Noise in two steps is noise in one.
TEST(TargetPrediction, DoesNotDependOnItsSteps) {
  TargetState state = unsure_state(1, 2);
  state.covariance.diagonal().tail<3>().setConstant(0.5);
  const TargetMotion motion{0.7, 0.3};
  const TargetState once = predict(state, at(3), motion),
                    twice = predict(predict(state, at(1.2), motion), at(3), motion);
  EXPECT_TRUE(once.covariance.isApprox(twice.covariance, 1e-12));
  EXPECT_TRUE(once.p_world.isApprox(twice.p_world));
}

// After 1 s: position q / 3, velocity q.
TEST(TargetPrediction, AddsWhiteAcceleration) {
  TargetState state;
  const TargetState predicted = predict(state, at(1), {0.6, 0.0});
  EXPECT_NEAR(predicted.covariance(0, 0), 0.2, 1e-15);
  EXPECT_NEAR(predicted.covariance(4, 1), 0.3, 1e-15);
  EXPECT_NEAR(predicted.covariance(5, 5), 0.6, 1e-15);
  EXPECT_TRUE(predicted.covariance.bottomRows<3>().isZero());
}

// A linear problem, for a bearing that is right: information adds up.
TEST(BearingUpdate, AddsTheBearingsInformation) {
  const TargetState state = unsure_state(0.3, 2);
  const Bearing bearing = bearing_of(state.p_world, {-80, 30, 5}, 0);
  const auto innovation = innovation_of(state, bearing);
  const TargetState updated = absorb(state, bearing, *innovation);
  const auto& J = innovation->J_residual_p;
  const Eigen::Matrix3d information =
      Eigen::Matrix3d::Identity() / 0.09 + J.transpose() * bearing.covariance.inverse() * J;
  const Eigen::Matrix3d P = updated.covariance.topLeftCorner<3, 3>();
  EXPECT_TRUE(P.inverse().isApprox(information, 1e-9));
  EXPECT_TRUE(updated.p_world.isApprox(state.p_world, 1e-12));
  EXPECT_TRUE(updated.covariance.bottomRows<3>().isZero());
}

// At the minimum of the prior's and the bearing's squares, which a single linearisation misses by far more.
TEST(BearingUpdate, IteratesToTheMostProbableState) {
  TargetState state = unsure_state(30, 2);
  const Vector3d truth = state.p_world + Vector3d(25, -20, 15);
  const Bearing bearing = bearing_of(truth, {-30, 0, 60}, 0);
  const auto slope_after = [&](int iterations) {
    BearingFilterOptions options;
    options.max_iterations = iterations;
    const TargetState updated = absorb(state, bearing, *innovation_of(state, bearing), options);
    const auto seen = innovation_of(updated, bearing);
    const Vector3d slope = (updated.p_world - state.p_world) / 900.0 +
                           seen->J_residual_p.transpose() * bearing.covariance.inverse() * seen->residual;
    return slope.norm();
  };
  EXPECT_LT(slope_after(10), 1e-3 * slope_after(1));
}

double nees(const TargetState& state, const Vector3d& p, const Vector3d& v) {
  Eigen::Matrix<double, 6, 1> error;
  error << state.p_world - p, state.v_world - v;
  return error.dot(state.covariance.topLeftCorner<6, 6>().ldlt().solve(error));
}

// Mean of 400 runs over 6 degrees: 1 ± 4 standard deviations of sqrt(2 / 2400).
TEST(BearingFilter, IsConsistentWithMotionAndNoise) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const auto any_vector = [&](double sigma) {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vector3d(sigma * Vector3d(x, y, z));
  };
  constexpr int kRuns = 400, kStepsPerSecond = 50;
  constexpr double kDensity = 0.5;
  BearingFilterOptions options;
  options.motion.acceleration_density = kDensity;
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    TargetState state = unsure_state(2, 3);
    Vector3d p = state.p_world + any_vector(2), v = state.v_world + any_vector(3);
    std::vector<Bearing> bearings;
    for (int step = 1; step <= 4 * kStepsPerSecond; ++step) {
      p += v / kStepsPerSecond;
      v += any_vector(std::sqrt(kDensity / kStepsPerSecond));
      if (step % 25 != 0) continue;
      const Vector3d origin = 120.0 * Vector3d(std::cos(2.1 * step), std::sin(2.1 * step), 0.0);
      bearings.push_back(bearing_of(p, origin, static_cast<double>(step) / kStepsPerSecond, &random));
    }
    sum += nees(filter_bearings(state, bearings, options), p, v);
  }
  EXPECT_NEAR(sum / (6.0 * kRuns), 1.0, 4.0 * std::sqrt(2.0 / (6.0 * kRuns)));
}

TEST(BearingFilter, NamesTheOptionThatIsWrong) {
  BearingFilterOptions options;
  options.motion.acceleration_density = -1.0;
  try {
    validate(options);
    FAIL() << "nothing was thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "acceleration_density must be >= 0 m^2/s^3, got -1");
  }
}

}  // namespace
}  // namespace alidade
