// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/genicam/tally.h"

#include <gtest/gtest.h>

namespace alidade::test {
namespace {

// Ten frames, of which the third was never sent.
std::vector<LoggedFrame> log_of_ten() {
  std::vector<LoggedFrame> log(10);
  for (std::uint32_t i = 0; i < 10; ++i)
    log[i] = {.id = static_cast<std::uint16_t>(i + 1), .picture = i, .device_time = 100 + i};
  log[2].is_dropped = true;
  return log;
}

SeenFrame good(std::uint32_t picture, std::uint64_t dropped_before = 0) {
  SeenFrame frame;
  frame.stamp.device_time = Timestamp(std::chrono::nanoseconds(100 + picture));
  frame.stamp.sequence = picture + 1;
  frame.stamp.dropped_before = dropped_before;
  frame.picture = picture;
  frame.is_exact = true;
  return frame;
}

TEST(Tally, CountsWhatCameBetweenTheFirstAndTheLastGoodFrame) {
  SeenFrame damaged = good(4);
  damaged.stamp.is_damaged = true;
  const Tally tally = tally_of({good(1), good(3, 1), damaged, good(5)}, log_of_ten());
  EXPECT_EQ(tally.exposed, 5);
  EXPECT_EQ(tally.never_sent, 1);
  EXPECT_EQ(tally.good, 3);
  EXPECT_EQ(tally.damaged, 1);
  EXPECT_EQ(tally.counted, 1);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_EQ(tally.unexplained(), 0);
}

TEST(Tally, SeesWhatNobodyToldOf) {
  EXPECT_EQ(tally_of({good(1), good(3)}, log_of_ten()).unexplained(), 1);
  EXPECT_EQ(tally_of({good(4), good(5, 1)}, log_of_ten()).unexplained(), -1);
}

// A damaged frame that lost its number is counted by the gap that it leaves.
TEST(Tally, CountsAFrameWithoutANumberOnce) {
  SeenFrame nameless;
  nameless.stamp.is_damaged = true;
  const Tally tally = tally_of({good(4), nameless, good(6, 1)}, log_of_ten());
  EXPECT_EQ(tally.nameless, 1);
  EXPECT_EQ(tally.unexplained(), 0);
}

TEST(Tally, TakesAFrameForWrongWherePixelsOrPictureAreOthers) {
  SeenFrame blurred = good(4);
  blurred.is_exact = false;
  SeenFrame other = good(5);
  other.picture = 4;
  EXPECT_EQ(tally_of({blurred, other, good(6)}, log_of_ten()).wrong, 2);
}

}  // namespace
}  // namespace alidade::test
