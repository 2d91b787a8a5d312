// SPDX-License-Identifier: Apache-2.0
#include "tracking/track_smoothing.h"

#include <gtest/gtest.h>

#include "tests/tracking/simulated_likelihoods.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 89;

class SmoothedTrack : public testing::Test {
 protected:
  SmoothedTrack() {
    for (std::size_t k = 0; k < simulated_.frames.size(); ++k) {
      FrameReport report;
      report.index = static_cast<int>(k);
      report.time = simulated_.frames[k].time;
      report.state = FrameState::Tracked;
      report.likelihood = simulated_.frames[k].sightings;
      report.T_world_camera = report.likelihood.T_world_body;
      reports_.push_back(report);
    }
  }

  double rmse(const std::vector<FrameReport>& reports) const {
    std::vector<Eigen::Isometry3d> poses;
    for (const FrameReport& r : reports) poses.push_back(r.T_world_camera);
    return test::position_rmse(poses, simulated_.truth);
  }

  test::RandomGeometry random_{kSeed};
  const test::SimulatedLikelihoods simulated_ = test::simulated_likelihoods(150, isotropic_noise(3e-3, 2e-3), random_);
  std::vector<FrameReport> reports_;
};

TEST_F(SmoothedTrack, IsBetterTheMoreItWaits) {
  const double alone = rmse(reports_), causal = rmse(smoothed(reports_, {.lag = 0})),
               lagged = rmse(smoothed(reports_, {.lag = 3})), all = rmse(smoothed(reports_));
  EXPECT_LT(causal, 0.8 * alone);
  EXPECT_LT(lagged, 0.85 * causal);
  EXPECT_LT(all, lagged);
}

TEST_F(SmoothedTrack, LeavesKeyframesAndWhatWasLost) {
  reports_[40].is_keyframe = true;
  reports_[70].state = FrameState::Lost;
  const auto after = smoothed(reports_);
  for (std::size_t k : {40u, 70u}) EXPECT_TRUE(after[k].T_world_camera.isApprox(reports_[k].T_world_camera, 0.0)) << k;
  EXPECT_FALSE(after[41].T_world_camera.isApprox(reports_[41].T_world_camera));
}

// What lies beyond a gap tells nothing: as if each side were a recording of its own.
TEST_F(SmoothedTrack, EndsAtAGap) {
  std::vector<FrameReport> apart = reports_;
  for (std::size_t k = 75; k < apart.size(); ++k) apart[k].time += from_seconds(10.0);
  const auto whole = smoothed(apart);
  const auto half = smoothed({apart.begin(), apart.begin() + 75});
  EXPECT_TRUE(whole[74].T_world_camera.isApprox(half[74].T_world_camera, 1e-12));
}

TEST_F(SmoothedTrack, LeavesAFewFramesAlone) {
  reports_.resize(8);
  const auto after = smoothed(reports_);
  EXPECT_TRUE(after[4].T_world_camera.isApprox(reports_[4].T_world_camera, 0.0));
}

}  // namespace
}  // namespace alidade
