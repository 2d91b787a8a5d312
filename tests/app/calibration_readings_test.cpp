// SPDX-License-Identifier: Apache-2.0
#include "app/calibration_readings.h"

#include <gtest/gtest.h>

#include "tests/support/input_error.h"

namespace alidade {
namespace {

std::vector<LineReading> ten() {
  std::vector<LineReading> readings;
  for (int i = 0; i < 10; ++i) readings.push_back({Timestamp(from_seconds(0.1 * i)), 0, i, 0.0, 0.0});
  return readings;
}

TEST(TimeInterval, OverlapsWhereAMomentIsInBoth) {
  EXPECT_TRUE(overlap({}, {}));
  EXPECT_TRUE(overlap({{}, 5.0}, {4.9, {}}));
  EXPECT_FALSE(overlap({{}, 5.0}, {5.0, {}}));
  EXPECT_FALSE(overlap({7.0, {}}, {5.0, 6.0}));
}

TEST(TakeInterval, TakesTheStartAndNotTheEnd) {
  const auto taken = take_interval(ten(), {0.3, 0.6}, {"a.csv", "--start", "--end"});
  ASSERT_EQ(taken.size(), 3u);
  EXPECT_EQ(taken.front().marker, 3);
  EXPECT_EQ(test::message_of("",
                             [] {
                               take_interval(ten(), {2.0, 3.0}, {"a.csv", "--start", "--end"});
                             }),
            "a.csv: no reading from 2 to 3 s; the recording spans 0.000 to 0.900 s; change --start or --end");
}

TEST(RepairTimes, LeavesReadingsThatNeedNoRepairWithoutAWord) {
  DetectorRig rig;
  rig.detectors.push_back({0, "a", FocalLine{}});
  std::vector<std::string> warnings;
  const auto same = repair_times(ten(), rig, "a.csv", warnings);
  ASSERT_EQ(same.size(), 10u);
  EXPECT_EQ(same.back().time, ten().back().time);
  EXPECT_TRUE(warnings.empty());
}

TEST(ChooseBody, WantsANameOnlyWhereThereAreSeveral) {
  const std::vector<RigidBody> bodies{{"left", {}}, {"right", {}}};
  EXPECT_EQ(choose_body({bodies[1]}, "", "b.csv").name, "right");
  EXPECT_EQ(choose_body(bodies, "right", "b.csv").name, "right");
  EXPECT_EQ(test::message_of("", [&] { choose_body(bodies, "", "b.csv"); }),
            "b.csv: holds 2 bodies: left, right; choose one by --body");
  EXPECT_EQ(test::message_of("", [&] { choose_body(bodies, "rigth", "b.csv"); }),
            "b.csv: no body 'rigth'; did you mean 'right'?");
}

TEST(RequireOverlap, RefusesPositionsOfAnotherTime) {
  std::vector<TimedPosition> positions(1);
  positions[0].time = Timestamp(from_seconds(5));
  EXPECT_NE(test::message_of("", [&] { require_overlap(positions, ten(), "p.csv"); }).find("p.csv: no position in the"),
            std::string::npos);
  positions[0].time = Timestamp(from_seconds(0.85));
  EXPECT_NO_THROW(require_overlap(positions, ten(), "p.csv"));
}

}  // namespace
}  // namespace alidade
