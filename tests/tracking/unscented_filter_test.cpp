// SPDX-License-Identifier: Apache-2.0
#include "tracking/unscented_filter.h"

#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/tracking/simulated_motion.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 71;

class UnscentedFilter : public testing::Test {
 protected:
  test::RandomGeometry random_{kSeed};
  test::SimulatedCamera simulated_ = test::simulated_camera(random_);
  MotionState predicted_ = test::belief_before_points(0.1);
};

// Where pixels are linear over the prediction's spread, it is the Kalman update.
TEST_F(UnscentedFilter, IsTheLinearUpdateForASmallCovariance) {
  predicted_.covariance *= 1e-6;
  simulated_.noise_px = 0.01;
  const MotionState truth = moved_by(predicted_, test::drawn(random_, predicted_.covariance));
  const auto observations = simulated_.frame(truth, random_).observations;
  const PosePrior prior{predicted_.T_world_body, predicted_.covariance.topLeftCorner<6, 6>().inverse()};
  PoseUpdateOptions options;
  options.gate_chi2 = 100;
  const auto exact = update_pose(simulated_.camera, prior, observations, options);
  ASSERT_TRUE(exact);
  ASSERT_EQ(exact->inlier_count, static_cast<int>(observations.size()));
  const MotionState expected = absorb(predicted_, exact->sightings);
  const Vector18d sigmas = expected.covariance.diagonal().cwiseSqrt();
  for (const double alpha : {1.0, 1e-3}) {
    const MotionState state = update_unscented_filter(simulated_.camera, predicted_, observations, {alpha});
    EXPECT_LT(error_between(expected, state).cwiseQuotient(sigmas).norm(), 1e-2) << "seed " << kSeed;
    const Matrix18d off =
        sigmas.asDiagonal().inverse() * (state.covariance - expected.covariance) * sigmas.asDiagonal().inverse();
    EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-3) << "alpha " << alpha << ", seed " << kSeed;
  }
}

TEST_F(UnscentedFilter, KeepsTheCovarianceSymmetricAndPositiveDefinite) {
  predicted_.covariance *= 100.0;  // 20 cm, 3 degrees
  const auto observations = simulated_.frame(predicted_, random_).observations;
  const MotionState state = update_unscented_filter(simulated_.camera, predicted_, observations);
  EXPECT_EQ(state.covariance, state.covariance.transpose());
  EXPECT_EQ(state.covariance.llt().info(), Eigen::Success);
  EXPECT_EQ((predicted_.covariance - state.covariance + 1e-12 * Matrix18d::Identity()).llt().info(), Eigen::Success);
}

TEST_F(UnscentedFilter, LeavesOutWhatASigmaPointDoesNotSee) {
  auto observations = simulated_.frame(predicted_, random_).observations;
  const MotionState expected = update_unscented_filter(simulated_.camera, predicted_, observations);
  PointObservation behind;
  behind.p_world = predicted_.T_world_body * Eigen::Vector3d(0, 0, -1);
  observations.push_back(behind);
  const MotionState state = update_unscented_filter(simulated_.camera, predicted_, observations);
  EXPECT_LT(error_between(expected, state).norm(), 1e-12);
}

TEST_F(UnscentedFilter, RefusesASpreadThatWouldWeighNegatively) {
  EXPECT_THROW(update_unscented_filter(simulated_.camera, predicted_, {}, {0.0}), std::invalid_argument);
  EXPECT_THROW(update_unscented_filter(simulated_.camera, predicted_, {}, {1.5}), std::invalid_argument);
}

// Over 200 trials the mean has mean 18 and variance 36/200: 99.9 % of means lie within 1.4 of 18.
TEST(UnscentedFilterConsistency, HoldsAfterTwentyFrames) {
  constexpr int kTrials = 200;
  double sum = 0.0;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    test::RandomGeometry random(kSeed + trial);
    test::SimulatedCamera simulated = test::simulated_camera(random);
    simulated.noise = {isotropic_noise(0.5, 0.2), isotropic_noise(2.0, 1.0)};
    MotionState state = test::belief_before_points(0.5);
    const MotionState start = moved_by(state, test::drawn(random, state.covariance));
    const auto frames = simulated.recording(start, 20, random);
    for (const test::SimulatedFrame& frame : frames) {
      const MotionState predicted = predict(state, frame.truth.time, simulated.noise);
      state = update_unscented_filter(simulated.camera, predicted, frame.observations);
    }
    sum += test::nees(state, frames.back().truth);
  }
  EXPECT_NEAR(sum / kTrials, 18.0, 1.4) << "seed " << kSeed;
}

}  // namespace
}  // namespace alidade
