// SPDX-License-Identifier: Apache-2.0
#include "marker1d/body_tracker.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "datasets/body_scene.h"
#include "estimation/line_bound.h"
#include "marker1d/body_smoother.h"

namespace alidade {
namespace {

struct Score {
  int frames = 0, tracked = 0, ambiguous = 0, starts = 0;
  double worst_m = 0.0;
  double square_m2 = 0.0, bound_m2 = 0.0;  // sums over tracked frames that determine the pose by themselves
  double all_square_m2 = 0.0, nees = 0.0;  // sums over tracked frames
  double smoothed_square_m2 = 0.0;
  int smoothed = 0;

  double to_bound() const { return std::sqrt(square_m2 / bound_m2); }
  double rms_m() const { return std::sqrt(all_square_m2 / tracked); }
  double nees_per_degree() const { return nees / tracked / 6.0; }
};

double nees(const MotionState& state, const Vector6d& error) {
  return error.dot(state.covariance.topLeftCorner<6, 6>().ldlt().solve(error));
}

void add_smoothed(const std::vector<BodyEstimate>& settled, Score& score) {
  for (const BodyEstimate& e : settled) {
    if (e.status != BodyStatus::Tracked) continue;
    score.smoothed_square_m2 += difference(e.state.T_world_body, pose_in_scene(0, e.time)).head<3>().squaredNorm();
    ++score.smoothed;
  }
}

Score tracked(const BodySceneOptions& options, const BodyTrackerOptions& tracker_options = {}) {
  BodyScene scene(options);
  const DetectorArray detectors(scene.detectors());
  BodyTracker tracker(detectors, scene.bodies().front(), tracker_options);
  BodySmoother smoother(50);
  Score score;
  while (const auto frame = scene.next()) {
    BodyEstimate e = tracker.track(frame->time, frame->readings);
    ++score.frames;
    score.starts += e.is_start;
    score.ambiguous += e.status == BodyStatus::Ambiguous;
    if (e.status == BodyStatus::Tracked) {
      const Eigen::Isometry3d truth = pose_in_scene(0, frame->time);
      const Vector6d error = difference(e.state.T_world_body, truth);
      const double square = error.head<3>().squaredNorm();
      ++score.tracked;
      score.worst_m = std::max(score.worst_m, std::sqrt(square));
      score.all_square_m2 += square;
      score.nees += nees(e.state, error);
      const auto bound =
          pose_bound(pose_information(scene.detectors(), scene.bodies().front(), truth, right_readings(*frame)));
      if (bound && bound->position_m2 < 1e-4) {
        score.square_m2 += square;
        score.bound_m2 += bound->position_m2;
      }
    }
    add_smoothed(smoother.add(std::move(e)), score);
  }
  add_smoothed(smoother.finish(), score);
  return score;
}

BodySceneOptions scene_of(int frames) {
  BodySceneOptions options;
  options.frames = frames;
  return options;
}

// A frame's readings bound what is known from them alone; the frames before add to it.
TEST(BodyTracker, BeatsTheBoundOfSingleFrames) {
  const Score score = tracked(scene_of(1000));
  EXPECT_EQ(score.tracked, 1000);
  EXPECT_EQ(score.starts, 1);
  EXPECT_LT(score.to_bound(), 0.9);
  EXPECT_GT(score.nees_per_degree(), 0.8);
  EXPECT_LT(score.nees_per_degree(), 1.25);
}

TEST(BodyTracker, HoldsTheBoundWithThirtyPercentWrongIds) {
  BodySceneOptions options = scene_of(1000);
  options.wrong_ids = 0.3;
  const Score score = tracked(options);
  EXPECT_EQ(score.tracked, 1000);
  EXPECT_LT(score.to_bound(), 1.0);
  EXPECT_LT(score.worst_m, 0.005);
}

TEST(BodyTracker, IsHonestUnderOcclusion) {
  BodySceneOptions options = scene_of(2000);
  options.occluded = 0.6;
  const Score score = tracked(options);
  EXPECT_GT(score.tracked, 1800);
  EXPECT_LT(score.rms_m(), 0.001);
  EXPECT_GT(score.nees_per_degree(), 0.8);
  EXPECT_LT(score.nees_per_degree(), 1.25);
}

TEST(BodyTracker, TakesEachReadingAtItsOwnTime) {
  BodySceneOptions options = scene_of(500);
  options.skew_s = 0.003;  // within which the body moves by up to 3 mm
  EXPECT_LT(tracked(options).worst_m, 0.005);
}

TEST(BodyTracker, LearnsTheSigmaOfTheReadings) {
  BodySceneOptions options = scene_of(500);
  BodyScene scene(options);
  std::vector<LineDetector> boastful = scene.detectors();
  for (LineDetector& d : boastful) d.sigma *= 0.5;
  const DetectorArray detectors(boastful);
  BodyTracker tracker(detectors, scene.bodies().front());
  while (auto frame = scene.next()) {
    for (LineReading& r : frame->readings) r.sigma = 0.0;
    tracker.track(frame->time, frame->readings);
  }
  EXPECT_NEAR(tracker.variance_factor(), 4.0, 0.2);
}

TEST(BodyTracker, IsLostWithoutReadingsAndStartsAgain) {
  BodyScene scene(scene_of(400));
  const DetectorArray detectors(scene.detectors());
  BodyTracker tracker(detectors, scene.bodies().front());
  int frame_index = 0;
  BodyEstimate estimate;
  while (const auto frame = scene.next()) {
    const bool is_dark = frame_index >= 100 && frame_index < 300;
    estimate = tracker.track(frame->time, is_dark ? std::vector<LineReading>{} : frame->readings);
    if (frame_index == 299) {
      EXPECT_EQ(estimate.status, BodyStatus::Lost);
    }
    ++frame_index;
  }
  EXPECT_EQ(estimate.status, BodyStatus::Tracked);
  const Vector6d error = difference(estimate.state.T_world_body, pose_in_scene(0, estimate.time));
  EXPECT_LT(error.head<3>().norm(), 0.002);
}

// Two markers leave the turn about their line open, however many planes there are.
TEST(BodyTracker, DoesNotGuessFromTwoMarkers) {
  BodyScene scene(scene_of(20));
  const DetectorArray detectors(scene.detectors());
  BodyTracker tracker(detectors, scene.bodies().front());
  while (auto frame = scene.next()) {
    std::erase_if(frame->readings, [](const LineReading& r) { return r.marker > 1; });
    EXPECT_EQ(tracker.track(frame->time, frame->readings).status, BodyStatus::Lost);
  }
}

TEST(BodyTracker, NamesTheOptionThatIsWrong) {
  BodyTrackerOptions options;
  options.most_position_sigma_m = 0.0;
  try {
    validate(options);
    FAIL() << "nothing was thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "most_position_sigma_m must be > 0 m, got 0");
  }
}

TEST(BodySmoother, HalvesTheErrorOfTheTracker) {
  const Score score = tracked(scene_of(1000));
  EXPECT_EQ(score.smoothed, score.tracked);
  EXPECT_LT(std::sqrt(score.smoothed_square_m2 / score.smoothed), 0.6 * score.rms_m());
}

TEST(BodySmoother, GivesEveryEstimateBackInOrder) {
  BodySmoother smoother(3);
  std::vector<Timestamp> times;
  const auto take = [&](const std::vector<BodyEstimate>& settled) {
    for (const BodyEstimate& e : settled) times.push_back(e.time);
  };
  for (int i = 0; i < 20; ++i) {
    BodyEstimate e;
    e.time = Timestamp(std::chrono::milliseconds(i));
    take(smoother.add(e));
  }
  take(smoother.finish());
  ASSERT_EQ(times.size(), 20U);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
}

TEST(BodySmoother, RefusesToLookNowhere) {
  EXPECT_THROW(BodySmoother(0), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
