// SPDX-License-Identifier: Apache-2.0
#include "estimation/state_smoother.h"

#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/tracking/simulated_motion.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 71;
constexpr double kStep_s = 0.1;

// At dynamic size: one set of expressions to compile.
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The translational part of a state or an error: place, velocity, acceleration.
VectorXd place_of(const MotionState& state) {
  VectorXd x(9);
  x << state.T_world_body.translation(), state.v_world, state.a_world;
  return x;
}

MatrixXd place_part(const MatrixXd& P) {
  constexpr int kFrom[] = {0, 6, 12};
  MatrixXd part(9, 9);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) part.block(3 * i, 3 * k, 3, 3) = P.block(kFrom[i], kFrom[k], 3, 3);
  }
  return part;
}

double largest_difference(const MatrixXd& a, const MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

// A camera that does not turn and whose place is measured: all is linear.
class SmoothLinear : public testing::Test {
 protected:
  static constexpr int kFrames = 8;

  SmoothLinear() {
    noise_.acceleration = isotropic_noise(2.0, 0.5);
    noise_.jerk = isotropic_noise(10.0, 1.0);
    Vector18d sigmas;
    sigmas << Vector6d::Constant(0.1), Vector6d::Constant(0.5), Vector6d::Constant(2.0);
    MotionState state;
    state.covariance = sigmas.cwiseAbs2().asDiagonal();
    first_ = state;
    for (int k = 0; k < kFrames; ++k) {
      MotionStep step;
      step.predicted = k == 0 ? state : predict(state, state.time + from_seconds(kStep_s), noise_);
      PoseLikelihood sightings;
      sightings.T_world_body.translation() = random_.vector(0.3);
      sightings.information.topLeftCorner<3, 3>() = R_.inverse();
      measured_.push_back(sightings.T_world_body.translation());
      step.state = state = absorb(step.predicted, sightings);
      steps_.push_back(step);
    }
  }

  test::RandomGeometry random_{kSeed};
  MotionNoise noise_;
  const Eigen::Matrix3d R_ = test::random_covariance(random_, 3, 0.05);
  MotionState first_;
  std::vector<Eigen::Vector3d> measured_;
  std::vector<MotionStep> steps_;
};

// Unknown: the first state, and the acceleration and jerk of each step; x_k = F x_{k-1} + G n_k.
TEST_F(SmoothLinear, IsTheLeastSquaresEstimateOfAllFramesTogether) {
  constexpr int kUnknowns = 9 + 6 * (kFrames - 1);
  constexpr double dt = kStep_s;
  const MatrixXd I = MatrixXd::Identity(3, 3), O = MatrixXd::Zero(3, 3);
  MatrixXd F(9, 9), G(9, 6);
  F << I, dt * I, dt * dt / 2 * I, O, I, dt * I, O, O, I;
  G << dt * dt * I, dt * dt * dt / 6 * I, dt * I, dt * dt / 2 * I, O, dt * I;
  std::vector<MatrixXd> A(kFrames, MatrixXd::Zero(9, kUnknowns));  // x_k = A_k unknowns
  MatrixXd N = MatrixXd::Zero(kUnknowns, kUnknowns);
  VectorXd b = VectorXd::Zero(kUnknowns);
  N.topLeftCorner(9, 9) = place_part(first_.covariance).inverse();
  const MatrixXd W = R_.inverse();
  for (int k = 0; k < kFrames; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (k == 0) {
      A[at].leftCols(9).setIdentity();
    } else {
      A[at] = F * A[at - 1];
      A[at].middleCols(9 + 6 * (k - 1), 6) = G;
      N.block(3 + 6 * k, 3 + 6 * k, 3, 3) = Eigen::Matrix3d(noise_.acceleration.topLeftCorner<3, 3>()).inverse();
      N.block(6 + 6 * k, 6 + 6 * k, 3, 3) = Eigen::Matrix3d(noise_.jerk.topLeftCorner<3, 3>()).inverse();
    }
    const MatrixXd H = A[at].topRows(3), WH = W * H;
    N += H.transpose() * WH;
    b += WH.transpose() * VectorXd(measured_[at]);
  }
  const MatrixXd P = N.inverse();
  const VectorXd unknowns = P * b;
  const std::vector<SmoothedState> smoothed = smooth(steps_);
  ASSERT_EQ(smoothed.size(), steps_.size());
  for (std::size_t k = 0; k < smoothed.size(); ++k) {
    EXPECT_LT((place_of(smoothed[k].state) - A[k] * unknowns).norm(), 1e-8) << "frame " << k << ", seed " << kSeed;
    EXPECT_LT(largest_difference(place_part(smoothed[k].state.covariance), A[k] * P * A[k].transpose()), 1e-8);
    if (k + 1 == smoothed.size()) continue;
    EXPECT_LT(largest_difference(place_part(smoothed[k].with_next), A[k] * P * A[k + 1].transpose()), 1e-8);
  }
}

TEST_F(SmoothLinear, LeavesTheLastState) {
  const SmoothedState last = smooth(steps_).back();
  EXPECT_TRUE(error_between(steps_.back().state, last.state).isZero(0.0));
  EXPECT_EQ(last.state.covariance, steps_.back().state.covariance);
  EXPECT_TRUE(last.with_next.isZero(0.0));
}

TEST_F(SmoothLinear, TakesVarianceOffAllButTheLast) {
  const std::vector<SmoothedState> smoothed = smooth(steps_);
  for (std::size_t k = 0; k + 1 < smoothed.size(); ++k) {
    const MatrixXd off = place_part(steps_[k].state.covariance) - place_part(smoothed[k].state.covariance);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(off, Eigen::EigenvaluesOnly);
    EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-12) << "frame " << k;
    EXPECT_GT(off.diagonal().minCoeff(), 1e-6) << "frame " << k;
  }
}

TEST_F(SmoothLinear, IsEmptyForNothing) {
  EXPECT_TRUE(smooth({}).empty());
}

// What is known to be constant stays so: no covariance, no noise, and no division by it.
TEST_F(SmoothLinear, LeavesWhatIsKnownExactly) {
  MotionState state = first_;
  state.covariance.bottomRows<6>().setZero();
  state.covariance.rightCols<6>().setZero();
  std::vector<MotionStep> steps;
  for (const Eigen::Vector3d& z : measured_) {
    MotionStep step;
    step.predicted = predict(state, state.time + from_seconds(kStep_s), {noise_.acceleration, Matrix6d::Zero()});
    PoseLikelihood sightings;
    sightings.T_world_body.translation() = z;
    sightings.information.topLeftCorner<3, 3>() = R_.inverse();
    step.state = state = absorb(step.predicted, sightings);
    steps.push_back(step);
  }
  const SmoothedState smoothed = smooth(steps).front();
  EXPECT_TRUE(smoothed.state.covariance.allFinite());
  EXPECT_LT(smoothed.state.a_world.norm() + smoothed.state.covariance.bottomRows<6>().norm(), 1e-12);
  EXPECT_GT(difference(steps.front().state.T_world_body, smoothed.state.T_world_body).norm(), 1e-3);
}

struct Smoothed {
  double nees = 0.0;                                 // mean over trials, of the sixth frame
  double square_m2 = 0.0, filtered_square_m2 = 0.0;  // mean squared error of place
};

Smoothed smooth_recordings(int trials) {
  Smoothed result;
  double frames_seen = 0.0;
  for (int trial = 0; trial < trials; ++trial) {
    test::RandomGeometry random(kSeed + static_cast<unsigned>(trial));
    test::SimulatedCamera simulated = test::simulated_camera(random);
    simulated.noise = {isotropic_noise(0.5, 0.2), isotropic_noise(2.0, 1.0)};
    const MotionState belief = test::belief_before_points(0.5);
    const MotionState truth = moved_by(belief, test::drawn(random, belief.covariance));
    const auto frames = simulated.recording(truth, 20, random);
    const auto steps = test::filtered(simulated, belief, frames, test::options_as_simulated(simulated.noise));
    const auto smoothed = smooth(steps);
    result.nees += test::nees(smoothed[5].state, frames[5].truth);
    for (std::size_t k = 0; k < smoothed.size(); ++k) {
      const MotionState &before = steps[k].state, &after = smoothed[k].state;
      result.square_m2 += difference(after.T_world_body, frames[k].truth.T_world_body).head<3>().squaredNorm();
      result.filtered_square_m2 +=
          difference(before.T_world_body, frames[k].truth.T_world_body).head<3>().squaredNorm();
      ++frames_seen;
    }
  }
  result.nees /= trials;
  result.square_m2 /= frames_seen;
  result.filtered_square_m2 /= frames_seen;
  return result;
}

// Over 200 trials the mean NEES has mean 18 and variance 36/200: 99.9 % of means lie within 1.4 of 18.
TEST(SmoothConsistency, HoldsOnTurningCameras) {
  const Smoothed smoothed = smooth_recordings(200);
  EXPECT_NEAR(smoothed.nees, 18.0, 1.4) << "seed " << kSeed;
  EXPECT_LT(smoothed.square_m2, 0.7 * smoothed.filtered_square_m2);
}

}  // namespace
}  // namespace alidade
