// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_filter.h"

#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/tracking/simulated_motion.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 67;

class FilterStepTest : public testing::Test {
 protected:
  Timestamp next_time() const { return before_.time + from_seconds(simulated_.dt); }

  static CameraFilterOptions calm() {
    CameraFilterOptions options;
    options.motion = {{{isotropic_noise(0.1, 0.05)}, 1.0}};
    return options;
  }

  test::RandomGeometry random_{kSeed};
  test::SimulatedCamera simulated_ = test::simulated_camera(random_);
  MotionState before_ = test::belief_before_points(0.1);
};

// 2 · 60 - 6 residuals count: a pose is six numbers.
constexpr double kDegreesOfFreedom = 114;

// Over 200 trials the mean has mean 18 and variance 36/200: 99.9 % of means lie within 1.4 of 18.
TEST(FilterStepConsistency, HoldsAfterTwentyFrames) {
  double sum = 0.0;
  constexpr int kTrials = 200;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    test::RandomGeometry random(kSeed + trial);
    test::SimulatedCamera simulated = test::simulated_camera(random);
    simulated.noise = {isotropic_noise(0.5, 0.2), isotropic_noise(2.0, 1.0)};
    const MotionState belief = test::belief_before_points(0.5);
    const MotionState truth = moved_by(belief, test::drawn(random, belief.covariance));
    const auto frames = simulated.recording(truth, 20, random);
    const auto steps = test::filtered(simulated, belief, frames, test::options_as_simulated(simulated.noise));
    ASSERT_EQ(steps.size(), frames.size()) << "seed " << kSeed + trial;
    sum += test::nees(steps.back().state, frames.back().truth);
  }
  EXPECT_NEAR(sum / kTrials, 18.0, 1.4) << "seed " << kSeed;
}

// The motion noise is 1 mm, the 400 sightings' as much; the jump is 2 cm.
class JumpInVelocity : public FilterStepTest {
 protected:
  JumpInVelocity() {
    simulated_ = test::simulated_camera(random_, 400);
    for (const double strength : {1.0, 3.0, 10.0}) {
      options_.motion.push_back({{isotropic_noise(0.9 * strength, 0.3 * strength)}, strength > 1 ? 0.015 : 0.97});
    }
    before_.covariance = 1e-8 * Matrix18d::Identity();
    truth_ = before_;
    truth_.v_world += jump_;
  }

  FilterStep step_to(const MotionState& truth) {
    simulated_.noise = {};
    const test::SimulatedFrame frame = simulated_.frame(simulated_.next(truth, random_), random_);
    return filter_step(simulated_.camera, before_, {}, next_time(), frame.observations, options_).value();
  }

  const Eigen::Vector3d jump_{0.0, -0.6, 0.0};
  CameraFilterOptions options_;
  MotionState truth_;
};

TEST_F(JumpInVelocity, IsFollowedInTheFrameWhereItBegins) {
  const FilterStep step = step_to(truth_);
  EXPECT_LT(step.motion.mode_weight.front(), 1e-3);
  EXPECT_NEAR((step.motion.state.v_world - before_.v_world).dot(jump_) / jump_.squaredNorm(), 1.0, 0.15);
  const MotionState now = test::driven(truth_, simulated_.dt, Vector6d::Zero(), Vector6d::Zero());
  const Vector6d off = difference(step.motion.state.T_world_body, now.T_world_body);
  EXPECT_LT(off.dot(step.motion.state.covariance.topLeftCorner<6, 6>().ldlt().solve(off)), 22.5) << "6 dof, 99.9 %";
}

// Two standard deviations of the strongest mode, fifteen of all modes' mean: no frame may be lost by it.
TEST_F(JumpInVelocity, IsFollowedHoweverSureTheSightingsAre) {
  simulated_.noise_px = 0.02;
  const test::SimulatedFrame frame = simulated_.frame(simulated_.next(truth_, random_), random_);
  const auto step = filter_step(simulated_.camera, before_, {}, next_time(), frame.observations, options_);
  ASSERT_TRUE(step);
  EXPECT_GT(step->motion.mode_weight.back(), 0.9);
  EXPECT_NEAR((step->motion.state.v_world - before_.v_world).dot(jump_) / jump_.squaredNorm(), 1.0, 0.05);
}

TEST_F(JumpInVelocity, IsMissedByNoiseOfOneStrength) {
  options_.motion = {{options_.motion.front().noise, 1.0}};
  const FilterStep step = step_to(truth_);
  const MotionState now = test::driven(truth_, simulated_.dt, Vector6d::Zero(), Vector6d::Zero());
  const Vector6d off = difference(step.motion.state.T_world_body, now.T_world_body);
  EXPECT_GT(off.dot(step.motion.state.covariance.topLeftCorner<6, 6>().ldlt().solve(off)), 22.5) << "6 dof, 99.9 %";
}

TEST_F(JumpInVelocity, IsNotSeenWhereThereIsNone) {
  const FilterStep step = step_to(before_);
  EXPECT_GT(step.motion.mode_weight.front(), 0.95);
}

// Weights by Bayes: prior weight times the density of the innovation, whose logarithm their sum has.
TEST_F(JumpInVelocity, IsWeighedByTheInnovationLikelihood) {
  truth_.v_world = before_.v_world + 0.3 * jump_;
  const FilterStep step = step_to(truth_);
  std::vector<double> density;
  double prior_sum = 0.0;
  for (const MotionMode& mode : options_.motion) {
    const double prior = density.empty() ? mode.weight : kCaution * mode.weight;
    const MotionState predicted = predict(before_, next_time(), mode.noise);
    density.push_back(prior * std::exp(log_evidence(predicted, step.update.sightings)));
    prior_sum += prior;
  }
  for (double& d : density) d /= prior_sum;
  const double sum = std::accumulate(density.begin(), density.end(), 0.0);
  ASSERT_EQ(step.motion.mode_weight.size(), 3u);
  for (std::size_t m = 0; m < 3; ++m) EXPECT_NEAR(step.motion.mode_weight[m], density[m] / sum, 1e-9) << m;
  EXPECT_NEAR(step.motion.log_evidence, std::log(sum), 1e-9);
  // In doubt, so that every part counts.
  EXPECT_LT(step.motion.mode_weight.front(), 0.95);
  EXPECT_GT(step.motion.mode_weight.front(), 0.05);
  const MotionState predicted = predict(before_, next_time(), mean_noise(options_.motion, step.motion.mode_weight));
  EXPECT_LT((step.motion.predicted.covariance - predicted.covariance).norm(), 1e-12);
  EXPECT_LT(error_between(step.motion.predicted, predicted).norm(), 1e-12);
  const MotionState absorbed = absorb(predicted, step.update.sightings);
  EXPECT_LT(error_between(step.motion.state, absorbed).norm(), 1e-9);
}

// The variance of 114 squares has a relative standard deviation of sqrt(2/114) = 0.13 after the first frame, and of
// sqrt(2/(114 · 40)) = 0.021 after 40; the gate takes 0.8 % off.
TEST_F(FilterStepTest, LearnsTheSightingsNoiseFromAnyGuess) {
  const CameraFilterOptions options = calm();
  for (const double noise_px : {0.2, 3.0}) {
    for (const double guess : {1.0 / 9, 1.0, 1e4}) {
      SCOPED_TRACE(testing::Message() << noise_px << " px, guess " << guess << " of its square, seed " << kSeed);
      simulated_.noise_px = noise_px;
      MotionState state = before_;
      SightingNoise noise{guess * noise_px * noise_px, 0.0};
      const auto frames = simulated_.recording(before_, 40, random_);
      for (std::size_t k = 0; k < frames.size(); ++k) {
        std::vector<PointObservation> observations = frames[k].observations;
        ASSERT_EQ(observations.size(), 60u);
        for (PointObservation& o : observations) o.sigma_px = 1.0;
        const auto step = filter_step(simulated_.camera, state, noise, frames[k].truth.time, observations, options);
        ASSERT_TRUE(step);
        state = step->motion.state;
        noise = step->noise;
        if (k == 0) {
          EXPECT_NEAR(noise.variance / (noise_px * noise_px), 1.0, 0.5);
          EXPECT_NEAR(noise.degrees_of_freedom, kDegreesOfFreedom, 4.0);
        }
      }
      EXPECT_NEAR(noise.variance / (noise_px * noise_px), 1.0, 0.08);
      EXPECT_NEAR(noise.degrees_of_freedom, 40 * kDegreesOfFreedom, 40.0);
    }
  }
}

TEST_F(FilterStepTest, LeavesTheSightingsNoiseWhereItIsTold) {
  CameraFilterOptions options = calm();
  options.learn_sighting_noise = false;
  simulated_.noise_px = 3.0;
  const auto frame = simulated_.frame(simulated_.next(before_, random_), random_);
  const auto step = filter_step(simulated_.camera, before_, {0.5, 7.0}, next_time(), frame.observations, options);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->noise.variance, 0.5);
  EXPECT_EQ(step->noise.degrees_of_freedom, 7.0);
}

TEST_F(FilterStepTest, GivesTheExactPoseOnExactSightings) {
  const CameraFilterOptions options = calm();
  simulated_.noise_px = 0.0;
  const MotionState truth = moved_by(before_, test::drawn(random_, before_.covariance));
  const auto frame = simulated_.frame(simulated_.next(truth, random_), random_);
  EXPECT_GT(difference(before_.T_world_body, truth.T_world_body).norm(), 0.01);
  const auto step = filter_step(simulated_.camera, before_, {}, next_time(), frame.observations, options);
  ASSERT_TRUE(step);
  EXPECT_LT(difference(frame.truth.T_world_body, step->motion.state.T_world_body).norm(), 1e-9);
}

TEST_F(FilterStepTest, IsEmptyWithTooFewSightings) {
  const CameraFilterOptions options = calm();
  auto frame = simulated_.frame(simulated_.next(before_, random_), random_);
  frame.observations.resize(6);
  EXPECT_TRUE(filter_step(simulated_.camera, before_, {}, next_time(), frame.observations, options));
  frame.observations.resize(5);
  EXPECT_FALSE(filter_step(simulated_.camera, before_, {}, next_time(), frame.observations, options));
}

}  // namespace
}  // namespace alidade
