// SPDX-License-Identifier: Apache-2.0
#include "tracking/recording_noise.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/tracking/simulated_likelihoods.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 83;

TEST(Blurred, AddsTheCovarianceAndKeepsThePeak) {
  test::RandomGeometry random(kSeed);
  const Matrix6d P = test::random_covariance(random, 6, 0.1), R = test::random_covariance(random, 6, 0.2);
  Vector6d gradient;
  for (double& value : gradient) value = random.normal();
  const PoseLikelihood sharp{random.pose(), P.inverse(), gradient};
  const PoseLikelihood blur = blurred(sharp, R);
  EXPECT_LT((blur.information.inverse() - P - R).norm(), 1e-9 * (P + R).norm());
  EXPECT_LT((blur.information.ldlt().solve(blur.gradient) - P * gradient).norm(), 1e-9 * (P * gradient).norm());
}

TEST(Blurred, LeavesUnknownWhatTheSightingsDoNotTell) {
  PoseLikelihood partial;
  partial.information.topLeftCorner<3, 3>() = 4.0 * Eigen::Matrix3d::Identity();
  const PoseLikelihood blur = blurred(partial, 0.75 * Matrix6d::Identity());
  EXPECT_LT((blur.information.topLeftCorner<3, 3>() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_TRUE((blur.information.bottomRows<3>().isZero(0.0)));
}

class LearnedRecordingNoise : public testing::Test {
 protected:
  test::RandomGeometry random_{kSeed};
  const Matrix6d common_ = isotropic_noise(3e-3, 2e-3);
  const test::SimulatedLikelihoods simulated_ = test::simulated_likelihoods(300, common_, random_);
  const MotionState first_ = test::before_likelihoods(simulated_);
  const RecordingNoise guess_{guessed_motion(0.3, 0.3, 1.0 / 30)};

  std::vector<Eigen::Isometry3d> filtered_with(const RecordingNoise& noise) const {
    std::vector<Eigen::Isometry3d> poses;
    for (const MotionStep& step : filter_recording(first_, simulated_.frames, noise)) {
      poses.push_back(step.state.T_world_body);
    }
    return poses;
  }
};

// 300 frames tell a variance to 8 %, and three of them to 5 %.
TEST_F(LearnedRecordingNoise, FindsWhatFramesAreOffBy) {
  const Matrix6d R = learned(guess_, first_, simulated_.frames, 30).pose;
  EXPECT_NEAR(std::sqrt(R.topLeftCorner<3, 3>().trace() / 3), 3e-3, 0.4e-3);
  EXPECT_NEAR(std::sqrt(R.bottomRightCorner<3, 3>().trace() / 3), 2e-3, 0.3e-3);
}

TEST_F(LearnedRecordingNoise, MakesTheFilterBetter) {
  std::vector<Eigen::Isometry3d> measured;
  for (const FrameLikelihood& frame : simulated_.frames) measured.push_back(frame.sightings.T_world_body);
  const double alone = test::position_rmse(measured, simulated_.truth);
  const RecordingNoise noise = learned(guess_, first_, simulated_.frames, 30);
  const double with = test::position_rmse(filtered_with(noise), simulated_.truth);
  EXPECT_LT(with, 0.75 * alone);
  EXPECT_LT(with, 0.85 * test::position_rmse(filtered_with({noise.motion}), simulated_.truth));
}

TEST_F(LearnedRecordingNoise, PassesOverFramesThatShowNothing) {
  std::vector<FrameLikelihood> frames = simulated_.frames;
  for (std::size_t k = 100; k < 110; ++k) frames[k].sightings = {};
  const RecordingNoise noise = learned(guess_, first_, frames, 10);
  EXPECT_TRUE(noise.pose.allFinite());
  const auto steps = filter_recording(first_, frames, noise);
  ASSERT_EQ(steps.size(), frames.size());
  EXPECT_GT(steps[109].state.covariance(0, 0), 4.0 * steps[99].state.covariance(0, 0));
}

TEST_F(LearnedRecordingNoise, NeedsTenFrames) {
  const RecordingNoise noise = learned(guess_, first_, std::span(simulated_.frames).first(9), 10);
  EXPECT_TRUE(noise.pose.isZero(0.0));
  EXPECT_EQ(noise.motion.front().noise.jerk, guess_.motion.front().noise.jerk);
}

}  // namespace
}  // namespace alidade
