// SPDX-License-Identifier: Apache-2.0
#include "evaluation/association.h"

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/evaluation/paths.h"

namespace alidade {
namespace {

Trajectory at_times(const std::vector<double>& seconds) {
  Trajectory trajectory;
  for (double time : seconds) trajectory.push_back(test::pose_at_time(time, {0, 0, 0}));
  return trajectory;
}

std::vector<std::pair<double, double>> times_of(const PairedTrajectories& pairs) {
  std::vector<std::pair<double, double>> times;
  for (std::size_t i = 0; i < pairs.truth.size(); ++i) {
    times.emplace_back(to_seconds(pairs.estimate[i].time.time_since_epoch()),
                       to_seconds(pairs.truth[i].time.time_since_epoch()));
  }
  return times;
}

using Times = std::vector<std::pair<double, double>>;

TEST(AssociateByTime, TakesTheNearestWithinTheLimit) {
  const auto pairs = associate_by_time(at_times({1.0, 2.0, 3.0}), at_times({0.0, 1.004, 1.006, 2.02, 2.995, 4.0}));
  EXPECT_EQ(times_of(pairs), (Times{{1.0, 1.004}, {3.0, 2.995}}));
}

TEST(AssociateByTime, StartsFromTheShorterWhicheverItIs) {
  const auto pairs = associate_by_time(at_times({0.0, 1.004, 1.006, 2.02, 2.995, 4.0}), at_times({1.0, 2.0, 3.0}));
  EXPECT_EQ(times_of(pairs), (Times{{1.004, 1.0}, {2.995, 3.0}}));
}

TEST(AssociateByTime, UsesEachPoseOnceForTheNearer) {
  const AssociationOptions wide{0.5, 0.0};
  EXPECT_EQ(times_of(associate_by_time(at_times({1.0, 1.2, 1.3}), at_times({1.1, 5.0, 6.0, 7.0}), wide)),
            (Times{{1.2, 1.1}}));
  EXPECT_EQ(times_of(associate_by_time(at_times({0.8, 1.05, 1.3}), at_times({1.1, 5.0, 6.0, 7.0}), wide)),
            (Times{{1.05, 1.1}}));
}

TEST(AssociateByTime, AddsTheOffsetToTheEstimate) {
  const Trajectory few = at_times({1.0, 2.0}), many = at_times({11.0, 12.0, 13.0});
  EXPECT_EQ(times_of(associate_by_time(few, many, {0.01, 10.0})), (Times{{1.0, 11.0}, {2.0, 12.0}}));
  EXPECT_EQ(times_of(associate_by_time(many, few, {0.01, -10.0})), (Times{{11.0, 1.0}, {12.0, 2.0}}));
  EXPECT_TRUE(associate_by_time(few, many, {0.01, -10.0}).truth.empty());
}

TEST(AssociateByTime, IsEmptyForEmptyTrajectories) {
  EXPECT_TRUE(associate_by_time({}, at_times({1.0})).estimate.empty());
  EXPECT_TRUE(associate_by_time(at_times({1.0}), {}).estimate.empty());
}

TEST(ShortestTimeApart, IsTheLeastOverAllPoses) {
  EXPECT_NEAR(shortest_time_apart_s(at_times({1.0, 2.0}), at_times({2.75, 4.0}), 0.0), 0.75, 1e-12);
  EXPECT_NEAR(shortest_time_apart_s(at_times({1.0, 2.0}), at_times({2.75, 4.0}), 0.5), 0.25, 1e-12);
  EXPECT_TRUE(std::isinf(shortest_time_apart_s({}, at_times({4.0}), 0.0)));
}

}  // namespace
}  // namespace alidade
