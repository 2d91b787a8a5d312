// SPDX-License-Identifier: Apache-2.0
#include "tracking/live_motion.h"

#include <gtest/gtest.h>

#include "tests/tracking/simulated_likelihoods.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 97;
constexpr double kDepth_m = 2.0, kFrame_s = 1.0 / 30;

PoseUpdate update_of(const FrameLikelihood& frame) {
  PoseUpdate update;
  update.T_world_camera = frame.sightings.T_world_body;
  update.covariance = frame.sightings.information.inverse();
  update.sightings = frame.sightings;
  return update;
}

class LiveMotionTest : public testing::Test {
 protected:
  LiveMotionTest() {
    motion_.find_anew(simulated_.frames[0].time, update_of(simulated_.frames[0]), kDepth_m, kFrame_s);
  }

  void follow_to(std::size_t frame) {
    while (last_ < frame) {
      ++last_;
      motion_.follow(simulated_.frames[last_].time, update_of(simulated_.frames[last_]));
      found_.push_back(motion_.state().T_world_body);
      estimated_.push_back(motion_.estimate().T_world_body);
    }
  }

  test::RandomGeometry random_{kSeed};
  const test::SimulatedLikelihoods simulated_ = test::simulated_likelihoods(400, isotropic_noise(3e-3, 2e-3), random_);
  LiveMotion motion_;
  std::size_t last_ = 0;
  std::vector<Eigen::Isometry3d> found_, estimated_;
};

TEST_F(LiveMotionTest, EstimatesBetterThanItFinds) {
  follow_to(399);
  const std::vector<StampedPose> truth(simulated_.truth.begin() + 1, simulated_.truth.end());
  EXPECT_LT(test::position_rmse(estimated_, truth), 0.8 * test::position_rmse(found_, truth));
}

TEST_F(LiveMotionTest, FindsItsWayByTheLastFrame) {
  follow_to(100);
  EXPECT_TRUE(motion_.state().T_world_body.isApprox(simulated_.frames[100].sightings.T_world_body));
  EXPECT_EQ(motion_.state().time, simulated_.frames[100].time);
  EXPECT_EQ(motion_.estimate().time, simulated_.frames[100].time);
}

TEST_F(LiveMotionTest, KnowsLessWithEveryFrameThatIsNotMeasured) {
  follow_to(100);
  const MotionState before = motion_.estimate();
  motion_.pass(simulated_.frames[101].time);
  EXPECT_GT(motion_.estimate().covariance(0, 0), before.covariance(0, 0));
  EXPECT_EQ(motion_.estimate().time, simulated_.frames[101].time);
}

TEST_F(LiveMotionTest, GoesWhereItIsFoundAfterAJump) {
  follow_to(100);
  FrameLikelihood far = simulated_.frames[101];
  far.sightings.T_world_body.translation() += Eigen::Vector3d(1, 2, 3);
  motion_.jump(far.time, update_of(far), kDepth_m, kFrame_s);
  for (const MotionState& state : {motion_.state(), motion_.estimate()}) {
    EXPECT_LT((state.T_world_body.translation() - far.sightings.T_world_body.translation()).norm(), 1e-6);
  }
}

TEST_F(LiveMotionTest, FollowsTheMapThatWasAdjusted) {
  follow_to(50);
  const Eigen::Isometry3d T = random_.pose();
  motion_.correct(T);
  EXPECT_TRUE(motion_.state().T_world_body.isApprox(T));
  EXPECT_TRUE(motion_.estimate().T_world_body.isApprox(T));
}

}  // namespace
}  // namespace alidade
