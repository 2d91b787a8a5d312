// SPDX-License-Identifier: Apache-2.0
#include "uav/paper/paper_candidates.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/uav/flown_scene.h"

namespace alidade {
namespace {

TargetScene table_scene(int targets, int receivers = 3, unsigned seed = 4) {
  TargetSceneOptions options = paper_table_scene(targets, {0.0, 0.1, 0.2, 0.3, 0.4}, seed);
  options.receivers = receivers;
  options.velocity_sigma_m_s = 5.0;
  return make_target_scene(options);
}

PaperOptions with(PaperMethod method) {
  PaperOptions options;
  options.method = method;
  return options;
}

TEST(PaperCandidates, AreAllChoicesOfOneBearingPerReceiver) {
  const auto bearings = bearings_of(table_scene(2));
  const auto triples = paper_candidates(bearings, with(PaperMethod::Proposed));
  const auto pairs = paper_candidates(bearings, with(PaperMethod::Alternative));
  ASSERT_EQ(triples.size(), 5u);
  ASSERT_EQ(pairs.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(triples[i].index, static_cast<std::int64_t>(i));
    EXPECT_EQ(pairs[i].candidates.size(), 4u);
    EXPECT_LE(triples[i].candidates.size(), 8u);
    for (const PaperCandidate& candidate : triples[i].candidates) {
      ASSERT_EQ(candidate.bearings.size(), 3u);
      for (int k = 0; k < 3; ++k) {
        const Bearing& bearing = bearings[candidate.bearings[static_cast<std::size_t>(k)]];
        EXPECT_EQ(bearing.receiver, k);
        EXPECT_EQ(std::floor(to_seconds(bearing.time.time_since_epoch())), static_cast<double>(i));
      }
      EXPECT_EQ(candidate.state.time, bearings[candidate.bearings[0]].time);
    }
  }
}

TEST(PaperCandidates, OnesOfOneTargetAreWhereItIs) {
  const TargetScene scene = table_scene(2);
  const auto bearings = bearings_of(scene);
  int right = 0;
  for (const PaperPeriod& period : paper_candidates(bearings, with(PaperMethod::Proposed))) {
    for (const PaperCandidate& candidate : period.candidates) {
      const int target = bearings[candidate.bearings[0]].target;
      if (std::any_of(candidate.bearings.begin(), candidate.bearings.end(),
                      [&](std::size_t b) { return bearings[b].target != target; })) {
        continue;
      }
      const TargetPath& path = scene.paths[static_cast<std::size_t>(target)];
      EXPECT_LT((candidate.state.p_world - position_at(path, candidate.state.time)).norm(), 1.5);
      ++right;
    }
  }
  EXPECT_EQ(right, 10);
}

TEST(PaperCandidates, NeedLinesThatPassNearEachOther) {
  PaperOptions options = with(PaperMethod::Alternative);
  options.pair_threshold_m = 1e-4;
  for (const PaperPeriod& period : paper_candidates(bearings_of(table_scene(1)), options)) {
    EXPECT_TRUE(period.candidates.empty());
  }
}

TEST(PaperCandidates, LieInFrontOfTheirReceivers) {
  auto bearings = bearings_of(table_scene(1));
  for (Bearing& bearing : bearings) bearing.direction_world *= -1.0;
  for (const auto method : {PaperMethod::Alternative, PaperMethod::Proposed}) {
    for (const PaperPeriod& period : paper_candidates(bearings, with(method))) EXPECT_TRUE(period.candidates.empty());
  }
}

TEST(PaperCandidates, UseTheReceiversThatSawSomething) {
  auto bearings = bearings_of(table_scene(1, 5));
  std::erase_if(bearings, [](const Bearing& b) {
    const double t = to_seconds(b.time.time_since_epoch());
    return (b.receiver == 1 && t < 1.0) || (b.receiver > 1 && t >= 1.0 && t < 2.0) || (t >= 2.0 && t < 3.0);
  });
  PaperOptions options;
  options.motion = PaperMotion::Acceleration;
  const auto periods = paper_candidates(bearings, options);
  ASSERT_EQ(periods.size(), 5u);
  ASSERT_EQ(periods[0].candidates.size(), 1u);
  EXPECT_EQ(periods[0].candidates[0].bearings.size(), 4u);
  EXPECT_EQ(periods[0].candidates[0].state.covariance(6, 6), 0.0);  // four receivers tell no acceleration
  EXPECT_TRUE(periods[1].candidates.empty());
  EXPECT_TRUE(periods[2].candidates.empty());  // nothing seen: a period all the same
  EXPECT_EQ(periods[3].index, 3);
  ASSERT_EQ(periods[4].candidates.size(), 1u);
  EXPECT_GT(periods[4].candidates[0].state.covariance(6, 6), 0.0);
}

TEST(PaperCandidates, PeriodsBeforeZeroAreToldByTheFloor) {
  auto bearings = bearings_of(table_scene(1));
  for (Bearing& bearing : bearings) bearing.time -= std::chrono::seconds(2);
  const auto periods = paper_candidates(bearings, {});
  ASSERT_EQ(periods.size(), 5u);
  EXPECT_EQ(periods.front().index, -2);
  for (const PaperPeriod& period : periods) EXPECT_EQ(period.candidates.size(), 1u);
}

TEST(PaperCandidates, AreNoneOfTooFewReceivers) {
  auto bearings = bearings_of(table_scene(1));
  EXPECT_TRUE(paper_candidates({}, {}).empty());
  std::erase_if(bearings, [](const Bearing& b) { return b.receiver == 2; });
  EXPECT_TRUE(paper_candidates(bearings, with(PaperMethod::Proposed)).empty());
  EXPECT_EQ(paper_candidates(bearings, with(PaperMethod::Alternative)).size(), 5u);
  std::erase_if(bearings, [](const Bearing& b) { return b.receiver == 1; });
  EXPECT_TRUE(paper_candidates(bearings, with(PaperMethod::Alternative)).empty());
}

TEST(PaperCandidates, RefuseANaN) {
  auto bearings = bearings_of(table_scene(1));
  bearings[1].direction_world.y() = std::nan("");
  for (const auto method : {PaperMethod::Alternative, PaperMethod::Proposed}) {
    EXPECT_THROW(paper_candidates(bearings, with(method)), std::invalid_argument);
  }
}

}  // namespace
}  // namespace alidade
