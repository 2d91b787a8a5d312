// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/target_tracker.h"

#include <algorithm>
#include <random>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "datasets/target_scene.h"
#include "uav/tracker/known_target.h"

namespace alidade {
namespace {

Timestamp at(double seconds) {
  return Timestamp(from_seconds(seconds));
}

TargetSceneOptions scene_of(int targets, unsigned seed) {
  TargetSceneOptions options;
  options.targets = targets;
  options.periods = 20;
  options.detection_probability = 0.95;
  options.false_bearings = 0.5;
  options.seed = seed;
  return options;
}

struct Watched {
  TargetScene scene;
  std::vector<Bearing> bearings;
};

Watched watched(const TargetSceneOptions& options) {
  Watched result{make_target_scene(options), {}};
  result.bearings = bearings_of(result.scene.receivers, result.scene.readings);
  return result;
}

// Estimates after each period's last look, of targets that are taken for real.
std::vector<std::vector<TargetEstimate>> follow(TargetTracker& tracker, const std::vector<Bearing>& bearings,
                                                int periods) {
  std::vector<std::vector<TargetEstimate>> answers;
  std::size_t next = 0;
  for (int period = 0; period < periods; ++period) {
    const Timestamp end = at(period + 0.2);
    for (; next < bearings.size() && bearings[next].time <= end; ++next) tracker.add(bearings[next]);
    answers.push_back(tracker.estimates_at(end));
    std::erase_if(answers.back(), [](const TargetEstimate& e) { return e.status == TargetStatus::Tentative; });
  }
  return answers;
}

const TargetEstimate* nearest(const std::vector<TargetEstimate>& estimates, const Eigen::Vector3d& p_world) {
  const auto found = std::min_element(estimates.begin(), estimates.end(), [&](const auto& a, const auto& b) {
    return (a.state.p_world - p_world).norm() < (b.state.p_world - p_world).norm();
  });
  return found == estimates.end() ? nullptr : &*found;
}

TEST(TargetTracker, FindsAllTargetsWithinThreePeriodsAndKeepsThem) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Watched w = watched(scene_of(2, seed));
    TargetTracker tracker;
    const auto answers = follow(tracker, w.bearings, 20);
    for (const TargetPath& path : w.scene.paths) {
      std::set<int> ids;
      for (int period = 3; period < 20; ++period) {
        const Timestamp time = at(period + 0.2);
        const TargetEstimate* e = nearest(answers[static_cast<std::size_t>(period)], position_at(path, time));
        ASSERT_TRUE(e) << "seed " << seed << ", period " << period;
        EXPECT_LT((e->state.p_world - position_at(path, time)).norm(), 4.2) << "seed " << seed << ", period " << period;
        ids.insert(e->id);
      }
      EXPECT_EQ(ids.size(), 1U) << "seed " << seed << ", target " << path.target;
    }
    for (const auto& estimates : answers) EXPECT_LE(estimates.size(), 2U) << "seed " << seed;
  }
}

TEST(TargetTracker, GivesUpATargetWithinThreePeriodsOfItsDeath) {
  TargetSceneOptions options = scene_of(3, 4);
  options.comes_and_goes = true;  // target 2 leaves at 16 s, target 1 comes at 4 s
  const Watched w = watched(options);
  TargetTracker tracker;
  const auto answers = follow(tracker, w.bearings, 20);
  EXPECT_EQ(answers[3].size(), 2U);
  EXPECT_EQ(answers[8].size(), 3U);
  EXPECT_EQ(answers[19].size(), 2U);
  const Eigen::Vector3d gone = position_at(w.scene.paths[2], at(16.2));
  EXPECT_GT((nearest(answers[19], gone)->state.p_world - gone).norm(), 1.0);
}

// The filter does as well as with labels on the bearings.
TEST(TargetTracker, LosesLittleToAssociation) {
  double own_m2 = 0.0, known_m2 = 0.0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Watched w = watched(scene_of(2, seed));
    TargetTracker tracker;
    const auto answers = follow(tracker, w.bearings, 20);
    for (const TargetPath& path : w.scene.paths) {
      std::vector<Bearing> of_it;
      std::copy_if(w.bearings.begin(), w.bearings.end(), std::back_inserter(of_it),
                   [&](const Bearing& b) { return b.target == path.target; });
      const std::vector<Timestamp> end{at(19.2)};
      const auto known = follow_known_target(of_it, end);
      ASSERT_TRUE(known[0]);
      const Eigen::Vector3d truth = position_at(path, end[0]);
      own_m2 += (nearest(answers[19], truth)->state.p_world - truth).squaredNorm();
      known_m2 += (known[0]->p_world - truth).squaredNorm();
    }
  }
  EXPECT_LT(std::sqrt(own_m2 / known_m2), 1.1);
}

void expect_same(const std::vector<TargetEstimate>& a, const std::vector<TargetEstimate>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].id, b[i].id);
    EXPECT_EQ(a[i].status, b[i].status);
    EXPECT_EQ(a[i].sightings, b[i].sightings);
    EXPECT_LT((a[i].state.p_world - b[i].state.p_world).norm(), 1e-9);
    EXPECT_LT((a[i].state.covariance - b[i].state.covariance).norm(), 1e-9);
  }
}

std::vector<Bearing> shuffled(std::vector<Bearing> bearings, double within_s, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> delay(0.0, within_s);
  std::vector<std::pair<Timestamp, Bearing>> arrivals;
  for (const Bearing& b : bearings) arrivals.emplace_back(b.time + from_seconds(delay(random)), b);
  std::sort(arrivals.begin(), arrivals.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < bearings.size(); ++i) bearings[i] = arrivals[i].second;
  return bearings;
}

// Asked about all the time, so that what is late meets an answer that was given without it.
TEST(TargetTracker, DoesNotMindTheOrderOfArrival) {
  for (const ScanAssociation association : {ScanAssociation::NearestNeighbour, ScanAssociation::Joint}) {
    TargetTrackerOptions options;
    options.association = association;
    const Watched w = watched(scene_of(3, 7));
    TargetTracker in_order(options), late(options);
    for (const Bearing& b : w.bearings) in_order.add(b);
    for (const Bearing& b : shuffled(w.bearings, 0.999, 3)) {
      EXPECT_TRUE(late.add(b));
      late.estimates_at(late.now());
    }
    EXPECT_EQ(late.left_out(), 0U);
    ASSERT_FALSE(in_order.estimates_at(at(19.3)).empty());
    expect_same(in_order.estimates_at(at(19.3)), late.estimates_at(at(19.3)));
  }
}

// And of the past: what was answered then, though more has been seen since.
TEST(TargetTracker, RemembersWhatItKnewWithinTheLag) {
  const Watched w = watched(scene_of(3, 8));
  TargetTracker now, later;
  for (const Bearing& b : w.bearings) {
    if (b.time <= at(12.15)) now.add(b);
    if (b.time <= at(13.05)) later.add(b);
  }
  later.estimates_at(at(13.1));
  expect_same(now.estimates_at(at(12.15)), later.estimates_at(at(12.15)));
}

TEST(TargetTracker, LeavesOutWhatComesTooLate) {
  TargetTracker tracker;
  Bearing bearing;
  bearing.time = at(10);
  EXPECT_TRUE(tracker.add(bearing));
  bearing.time = at(9.1);
  EXPECT_TRUE(tracker.add(bearing));
  bearing.time = at(8.9);
  EXPECT_FALSE(tracker.add(bearing));
  EXPECT_EQ(tracker.left_out(), 1U);
  EXPECT_EQ(tracker.now(), at(10));
}

TEST(TargetTracker, AnswersNothingBeforeItHasSeenAnything) {
  TargetTracker tracker;
  EXPECT_TRUE(tracker.estimates_at(at(5)).empty());
  tracker.advance(at(100));
  EXPECT_TRUE(tracker.estimates_at(at(100)).empty());
}

TEST(TargetTracker, IsNotFooledByFalseBearingsAlone) {
  TargetSceneOptions options = scene_of(1, 2);
  options.periods = 60;
  options.detection_probability = 0.0;
  options.false_bearings = 3.0;
  const Watched w = watched(options);
  TargetTrackerOptions tracker_options;
  tracker_options.false_bearings_per_sr = 30.0;
  TargetTracker tracker(tracker_options);
  for (const auto& estimates : follow(tracker, w.bearings, 60)) EXPECT_TRUE(estimates.empty());
}

// A target that nobody sees goes on for a while, marked as such, and then is gone; its id does not come back.
TEST(TargetTracker, CoastsThenGivesUpAndNamesNoOneTheSame) {
  TargetSceneOptions options = scene_of(1, 3);
  options.false_bearings = 0.0;
  options.detection_probability = 1.0;
  options.periods = 30;
  Watched w = watched(options);
  std::erase_if(w.bearings, [](const Bearing& b) { return b.time > at(9.5) && b.time < at(15.5); });
  TargetTracker tracker;
  const auto answers = follow(tracker, w.bearings, 30);
  ASSERT_EQ(answers[9].size(), 1U);
  EXPECT_EQ(answers[9][0].status, TargetStatus::Confirmed);
  ASSERT_EQ(answers[11].size(), 1U);
  EXPECT_EQ(answers[11][0].status, TargetStatus::Coasting);
  EXPECT_TRUE(answers[14].empty());
  ASSERT_EQ(answers[20].size(), 1U);
  EXPECT_NE(answers[20][0].id, answers[9][0].id);
}

TEST(TargetTracker, AveragesTheTemperature) {
  TargetSceneOptions options = scene_of(1, 3);
  options.false_bearings = 0.0;
  Watched w = watched(options);
  std::mt19937_64 random(9);
  std::normal_distribution<double> reading(310.0, 2.0);
  for (Bearing& b : w.bearings) {
    if (b.receiver == 2) b.temperature_k = reading(random);
  }
  TargetTracker tracker;
  for (const Bearing& b : w.bearings) tracker.add(b);
  const auto estimates = tracker.estimates_at(at(19.3));
  ASSERT_EQ(estimates.size(), 1U);
  EXPECT_GE(estimates[0].temperature_readings, 17);
  EXPECT_NEAR(estimates[0].temperature_mean_k, 310.0, 4.0 * 2.0 / std::sqrt(17.0));
  EXPECT_NEAR(estimates[0].temperature_spread_k, 2.0, 1.5);
}

// Of 9,000 bearings, 4.5 in a period: those of two lags, and of four periods those that no track took.
TEST(TargetTracker, DoesNotGrowWithTime) {
  TargetSceneOptions options = scene_of(1, 5);
  options.velocity_sigma_m_s = 0.0;
  options.scatter_m_s = 0.01;
  options.periods = 2000;
  const Watched w = watched(options);
  TargetTracker tracker;
  std::size_t most = 0;
  for (const Bearing& b : w.bearings) {
    tracker.add(b);
    most = std::max(most, tracker.remembered());
  }
  EXPECT_LT(most, 60U);
  EXPECT_EQ(tracker.estimates_at(tracker.now()).size(), 1U);
}

TEST(TargetTracker, RefusesWhatIsNoBearing) {
  TargetTracker tracker;
  Bearing bearing;
  bearing.direction_world = {0, 0, 2};
  EXPECT_THROW(tracker.add(bearing), std::invalid_argument);
  bearing.direction_world = {0, 0, 1};
  bearing.covariance.setZero();
  EXPECT_THROW(tracker.add(bearing), std::invalid_argument);
  bearing.covariance.setIdentity();
  bearing.direction_world = {0, 0, std::nan("")};
  EXPECT_THROW(tracker.add(bearing), std::invalid_argument);
}

TEST(TargetTracker, NamesTheOptionThatIsWrong) {
  TargetTrackerOptions options;
  options.scan_s = 2.0;
  try {
    TargetTracker tracker(options);
    FAIL() << "nothing was thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "scan_s must be >= 0 s and below period_s, got 2");
  }
}

}  // namespace
}  // namespace alidade
