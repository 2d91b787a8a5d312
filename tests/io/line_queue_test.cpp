// SPDX-License-Identifier: Apache-2.0
#include "io/line_queue.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(LineQueue, GivesLinesInOrder) {
  LineQueue queue(4);
  EXPECT_TRUE(queue.empty());
  queue.push("a");
  queue.push("b");
  EXPECT_EQ(queue.pop(), "a");
  EXPECT_EQ(queue.pop(), "b");
  EXPECT_EQ(queue.pop(), std::nullopt);
  EXPECT_EQ(queue.take_lost(), 0u);
}

TEST(LineQueue, GivesUpTheOlderHalfWhereThereIsNoRoom) {
  LineQueue queue(4);
  for (const char* line : {"0", "1", "2", "3", "4"}) queue.push(line);
  EXPECT_EQ(queue.take_lost(), 2u);
  EXPECT_EQ(queue.take_lost(), 0u);
  EXPECT_EQ(queue.pop(), "2");
}

TEST(LineQueue, CountsEveryLineAsGivenOrLost) {
  LineQueue queue(7);
  for (int i = 0; i < 1000; ++i) queue.push("line");
  std::uint64_t count = queue.take_lost();
  while (queue.pop()) ++count;
  EXPECT_EQ(count, 1000u);
}

TEST(LineQueue, NeedsRoom) {
  EXPECT_THROW(LineQueue(1), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
