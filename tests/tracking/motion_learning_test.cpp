// SPDX-License-Identifier: Apache-2.0
#include "estimation/motion_learning.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "tests/tracking/simulated_motion.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 79;

// Thirty short recordings of a camera that is driven by jerk alone, more strongly to the side and about one axis.
class LearnMotion : public testing::Test {
 protected:
  LearnMotion() {
    Vector6d sigmas;
    sigmas << 0.5, 1.5, 0.5, 0.1, 0.1, 0.3;
    simulated_.dt = 0.1;
    simulated_.noise_px = 0.02;
    simulated_.noise.jerk = sigmas.cwiseAbs2().asDiagonal();
    simulated_.noise.jerk(0, 1) = simulated_.noise.jerk(1, 0) = 0.4;
    for (int i = 0; i < 30; ++i) {
      const MotionState truth = moved_by(belief_, test::drawn(random_, belief_.covariance));
      recorded_.push_back(simulated_.recording(truth, 15, random_));
    }
  }

  std::vector<std::vector<MotionStep>> filtered_with(const MotionProcess& motion) {
    CameraFilterOptions options = test::options_as_simulated({});
    options.motion = motion;
    std::vector<std::vector<MotionStep>> recordings;
    for (const auto& frames : recorded_) {
      recordings.push_back(test::filtered(simulated_, belief_, frames, options));
      EXPECT_EQ(recordings.back().size(), frames.size());
    }
    log_evidence_.push_back(0.0);
    for (const auto& steps : recordings) {
      for (const MotionStep& step : steps) log_evidence_.back() += step.log_evidence;
    }
    return recordings;
  }

  MotionProcess learned_from(double jerk_sigma, int steps) {
    const MotionProcess guess{{{Matrix6d::Zero(), isotropic_noise(jerk_sigma, jerk_sigma)}, 1.0}};
    return learn_motion(guess, steps, [this](const MotionProcess& motion) { return filtered_with(motion); });
  }

  test::RandomGeometry random_{kSeed};
  test::SimulatedCamera simulated_ = test::simulated_camera(random_);
  const MotionState belief_ = test::belief_before_points(0.05);
  std::vector<std::vector<test::SimulatedFrame>> recorded_;
  std::vector<double> log_evidence_;
};

// Of 420 jerks that are seen exactly, the extreme ratios of variance are about (1 ± sqrt(6/420))²: 0.78 and 1.25.
// These are seen through noise, and the last steps, which gain little, are not taken.
TEST_F(LearnMotion, RecoversTheCovarianceOfTheJerk) {
  for (const double guess : {0.25, 5.0}) {
    const MotionProcess motion = learned_from(guess, 20);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> ratios(motion[0].noise.jerk, simulated_.noise.jerk);
    EXPECT_GT(ratios.eigenvalues().minCoeff(), 0.65) << "guess " << guess << ", seed " << kSeed;
    EXPECT_LT(ratios.eigenvalues().maxCoeff(), 1.65) << "guess " << guess << ", seed " << kSeed;
  }
}

TEST_F(LearnMotion, MakesTheRecordingsMoreProbableAtEveryStep) {
  for (const double guess : {0.25, 5.0}) {
    log_evidence_.clear();
    learned_from(guess, 12);
    for (std::size_t k = 1; k < log_evidence_.size(); ++k) {
      EXPECT_GT(log_evidence_[k], log_evidence_[k - 1] - 0.1) << "step " << k << ", guess " << guess;
    }
    EXPECT_GT(log_evidence_.back(), log_evidence_.front() + 1000.0) << "guess " << guess << ", seed " << kSeed;
  }
}

// One of ten frames begins with a jump of the accelerations.
TEST_F(LearnMotion, LearnsHowOftenTheMotionIsAManoeuvre) {
  const Matrix6d calm = simulated_.noise.jerk, jump = isotropic_noise(1.0, 0.2);
  double jumps = 0.0, frames_seen = 0.0;
  for (auto& frames : recorded_) {
    MotionState state = moved_by(belief_, test::drawn(random_, belief_.covariance));
    for (test::SimulatedFrame& frame : frames) {
      const bool is_manoeuvre = random_.uniform(0, 1) < 0.1;
      simulated_.noise.jump = is_manoeuvre ? jump : Matrix6d::Zero();
      frame = simulated_.frame(state = simulated_.next(state, random_), random_);
      jumps += is_manoeuvre;
      ++frames_seen;
    }
  }
  const Matrix6d none = Matrix6d::Zero();
  const MotionProcess guess{{{none, 4.0 * calm}, 0.5}, {{none, none, 9.0 * jump}, 0.5}};
  const MotionProcess motion =
      learn_motion(guess, 40, [this](const MotionProcess& with) { return filtered_with(with); });
  // Between how often it is one and how often it is feared to be.
  const double share = jumps / frames_seen;
  EXPECT_GT(motion[1].weight, share - 0.03) << "seed " << kSeed;
  EXPECT_LT(motion[1].weight, kCaution * share / (1.0 + (kCaution - 1.0) * share) + 0.03) << "seed " << kSeed;
  EXPECT_NEAR(motion[0].weight + motion[1].weight, 1.0, 1e-12);
  EXPECT_NEAR(std::log(motion[1].noise.jump.trace() / jump.trace()), 0.0, 0.5);
  EXPECT_NEAR(std::log(motion[0].noise.jerk.trace() / calm.trace()), 0.0, 0.5);
  EXPECT_TRUE(motion[0].noise.jump.isZero(0.0) && motion[1].noise.jerk.isZero(0.0));
  EXPECT_GT(log_evidence_.back(), log_evidence_.front() + 100.0);
}

// The accelerations change as a step begins, and by nothing else.
TEST_F(LearnMotion, RecoversTheCovarianceOfTheJump) {
  simulated_.noise.jump = 0.01 * simulated_.noise.jerk;
  simulated_.noise.jerk.setZero();
  for (auto& frames : recorded_) {
    frames = simulated_.recording(moved_by(belief_, test::drawn(random_, belief_.covariance)), 15, random_);
  }
  MotionProcess motion(1);
  motion[0].noise.jump = isotropic_noise(1, 1);
  motion = learn_motion(motion, 15, [this](const MotionProcess& with) { return filtered_with(with); });
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> ratios(motion[0].noise.jump, simulated_.noise.jump);
  EXPECT_GT(ratios.eigenvalues().minCoeff(), 0.65) << "seed " << kSeed;
  EXPECT_LT(ratios.eigenvalues().maxCoeff(), 1.5) << "seed " << kSeed;
  EXPECT_TRUE(motion[0].noise.jerk.isZero(0.0) && motion[0].noise.acceleration.isZero(0.0));
}

TEST_F(LearnMotion, NeedsTenSteps) {
  const MotionProcess motion{{{Matrix6d::Zero(), isotropic_noise(2, 2)}, 0.5},
                             {{Matrix6d::Zero(), isotropic_noise(5, 5)}, 0.5}};
  auto recordings = filtered_with(motion);
  recordings.resize(1);
  recordings[0].resize(10);  // nine steps from frame to frame
  const MotionProcess same = learned(motion, recordings);
  EXPECT_EQ(same[0].noise.jerk, motion[0].noise.jerk);
  EXPECT_EQ(same[1].weight, 0.5);
  recordings[0] = filtered_with(motion)[0];
  recordings[0].resize(11);
  EXPECT_NE(learned(motion, recordings)[0].noise.jerk, motion[0].noise.jerk);
}

}  // namespace
}  // namespace alidade
