// SPDX-License-Identifier: Apache-2.0
#include "evaluation/track_identity.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using Places = std::vector<IdentifiedPosition>;

TargetMoment moment(int second, const Places& truth, const Places& estimates) {
  return {Timestamp(std::chrono::seconds(second)), truth, estimates};
}

IdentifiedPosition is_at(int id, double x) {
  return {id, {x, 0, 0}};
}

TEST(TrackIdentity, CountsASwitchOncePerTarget) {
  const Places truth{is_at(0, 0), is_at(1, 10)};
  const std::vector<TargetMoment> moments{moment(0, truth, {is_at(7, 0), is_at(8, 10)}),
                                          moment(1, truth, {is_at(7, 10), is_at(8, 0)}),
                                          moment(2, truth, {is_at(7, 10), is_at(8, 0)})};
  const TrackIdentity identity = track_identity(moments, 2.0);
  EXPECT_EQ(identity.switches, 2);
  EXPECT_EQ(identity.targets[0].switches, 1);
  EXPECT_NEAR(identity.purity, 4.0 / 6.0, 1e-12);
  EXPECT_EQ(identity.completeness, 1.0);
}

// Between the two there is no estimate: the id that was, is remembered.
TEST(TrackIdentity, CountsASwitchAcrossAGap) {
  const Places truth{is_at(0, 0)};
  const std::vector<TargetMoment> moments{moment(0, truth, {is_at(7, 1)}), moment(1, truth, {}),
                                          moment(2, truth, {is_at(8, 1)})};
  const TrackIdentity identity = track_identity(moments, 2.0);
  EXPECT_EQ(identity.switches, 1);
  EXPECT_NEAR(identity.completeness, 2.0 / 3.0, 1e-12);
  EXPECT_EQ(identity.purity, 1.0);
}

TEST(TrackIdentity, TellsWhenATargetIsFoundAndGivenUp) {
  const std::vector<TargetMoment> moments{moment(0, {is_at(0, 0)}, {}), moment(2, {is_at(0, 0)}, {is_at(7, 0)}),
                                          moment(3, {}, {is_at(7, 0)}), moment(5, {}, {is_at(7, 0)}),
                                          moment(6, {}, {})};
  const TrackIdentity identity = track_identity(moments, 2.0);
  ASSERT_EQ(identity.targets.size(), 1U);
  EXPECT_EQ(identity.targets[0].found_s, 2.0);
  EXPECT_EQ(identity.targets[0].outlived_s, 3.0);
}

TEST(TrackIdentity, DoesNotKnowWhatLivesToTheEnd) {
  const std::vector<TargetMoment> moments{moment(0, {is_at(0, 0), is_at(1, 50)}, {is_at(7, 0)})};
  const TrackIdentity identity = track_identity(moments, 2.0);
  EXPECT_FALSE(identity.targets[0].outlived_s);
  EXPECT_FALSE(identity.targets[1].found_s);
}

TEST(TrackIdentity, CountsIdsThatAreNeverOfATarget) {
  const std::vector<TargetMoment> moments{moment(0, {is_at(0, 0)}, {is_at(7, 0), is_at(8, 30)}),
                                          moment(1, {is_at(0, 0)}, {is_at(7, 0), is_at(8, 31), is_at(9, -40)})};
  const TrackIdentity identity = track_identity(moments, 2.0);
  EXPECT_EQ(identity.false_ids, 2);
  EXPECT_EQ(identity.switches, 0);
}

TEST(PairByPlace, TakesTheLeastSquaresWithinTheRadius) {
  const auto pairs =
      pair_by_place(moment(0, {is_at(0, 0), is_at(1, 3), is_at(2, 50)}, {is_at(7, 1.6), is_at(8, 3.4)}), 2.0);
  EXPECT_EQ(pairs[0], 0U);
  EXPECT_EQ(pairs[1], 1U);
  EXPECT_FALSE(pairs[2]);
}

TEST(TrackIdentity, RefusesMomentsOutOfOrder) {
  const std::vector<TargetMoment> moments{moment(1, {}, {}), moment(0, {}, {})};
  EXPECT_THROW(track_identity(moments, 2.0), std::invalid_argument);
  EXPECT_THROW(track_identity({}, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
