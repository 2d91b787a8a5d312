// SPDX-License-Identifier: Apache-2.0
#include "tracking/slam_track.h"

#include <numeric>

#include <gtest/gtest.h>

#include "tests/tracking/simulated_motion.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 79;

class SlamTrackTest : public testing::Test {
 protected:
  SlamTrackTest() {
    map_.points = simulated_.points;
    for (MapPoint& p : map_.points) p.covariance_world = 1e-4 * Eigen::Matrix3d::Identity();
    living_.resize(map_.points.size());
    std::iota(living_.begin(), living_.end(), 0);
  }

  // Sightings of points `first` to `last` - 1.
  SlamFrame frame(const MotionState& truth, int first, int last) {
    SlamFrame frame{truth.time, {isotropic_noise(0.1, 0.05)}, {}, 0.5};
    const auto seen = test::sightings_from(simulated_.camera, map_.points, truth.T_world_body, 0.5, random_);
    for (const Sighting& s : seen) {
      if (s.point >= first && s.point < last) frame.inliers.push_back({s.point, -1, s.pixel});
    }
    return frame;
  }

  test::RandomGeometry random_{kSeed};
  test::SimulatedCamera simulated_ = test::simulated_camera(random_);
  PointMap map_;
  std::vector<int> living_;
  MotionState camera_ = test::belief_before_points(0.0);
};

TEST_F(SlamTrackTest, FollowsTheCamera) {
  SlamTrack track{slam_state(camera_), {}};
  MotionState truth = moved_by(camera_, test::drawn(random_, camera_.covariance));
  for (int k = 0; k < 20; ++k) {
    truth = simulated_.next(truth, random_);
    track = follow(simulated_.camera, track, map_, living_, frame(truth, 0, 60), 40);
  }
  EXPECT_EQ(track.map_points.size(), 40u);
  const Vector6d off = difference(track.state.camera.T_world_body, truth.T_world_body);
  const Matrix6d P = track.state.covariance.topLeftCorner<6, 6>();
  EXPECT_LT(off.dot(P.ldlt().solve(off)), 22.5) << "6 dof, 99.9 %, seed " << kSeed;
  EXPECT_LT(off.norm(), 0.02);
}

TEST_F(SlamTrackTest, MakesRoomByWhatIsNotSeen) {
  SlamTrack track{slam_state(camera_), {}};
  track = follow(simulated_.camera, track, map_, living_, frame(camera_, 0, 20), 30);
  track = follow(simulated_.camera, track, map_, living_, frame(camera_, 10, 20), 30);
  EXPECT_EQ(track.map_points.size(), 20u) << "all stay where there is room";
  track = follow(simulated_.camera, track, map_, living_, frame(camera_, 10, 40), 30);
  EXPECT_EQ(track.map_points.size(), 30u);
  for (int point : track.map_points) EXPECT_GE(point, 10);
}

TEST_F(SlamTrackTest, DropsWhatTheMapHasDropped) {
  SlamTrack track{slam_state(camera_), {}};
  track = follow(simulated_.camera, track, map_, living_, frame(camera_, 0, 20), 30);
  living_.erase(living_.begin(), living_.begin() + 5);
  track = follow(simulated_.camera, track, map_, living_, frame(camera_, 5, 20), 30);
  EXPECT_EQ(track.map_points.size(), 15u);
  EXPECT_EQ(track.state.covariance.rows(), 12 + 3 * 15);
}

}  // namespace
}  // namespace alidade
