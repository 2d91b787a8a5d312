// SPDX-License-Identifier: Apache-2.0
#include "marker1d/reading_batches.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

LineReading at_ms(int ms) {
  return {Timestamp(std::chrono::milliseconds(ms)), 0, 0, 0.0, 0.0};
}

TEST(ReadingBatches, EndWhereTheSpanIsOver) {
  ReadingBatches batches(std::chrono::milliseconds(4));
  EXPECT_FALSE(batches.add(at_ms(10)));
  EXPECT_FALSE(batches.add(at_ms(13)));
  const auto first = batches.add(at_ms(14));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->readings.size(), 2U);
  EXPECT_EQ(first->time, Timestamp(std::chrono::microseconds(11500)));
  const auto last = batches.finish();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->time, Timestamp(std::chrono::milliseconds(14)));
  EXPECT_FALSE(batches.finish());
}

TEST(ReadingBatches, HoldReadingsOfOneMomentTogether) {
  ReadingBatches batches(std::chrono::milliseconds(0));
  EXPECT_FALSE(batches.add(at_ms(1)));
  EXPECT_FALSE(batches.add(at_ms(1)));
  EXPECT_TRUE(batches.add(at_ms(2)));
}

}  // namespace
}  // namespace alidade
