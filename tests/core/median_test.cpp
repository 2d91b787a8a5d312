// SPDX-License-Identifier: Apache-2.0
#include "core/median.h"

#include <chrono>

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(Median, IsTheMiddleOneBySize) {
  EXPECT_EQ(median(std::vector{5.0, -1.0, 3.0}), 3.0);
  EXPECT_EQ(median(std::vector{7}), 7);
}

TEST(Median, IsTheUpperOfTwoInTheMiddle) {
  EXPECT_EQ(median(std::vector{4.0, 1.0, 3.0, 2.0}), 3.0);
}

TEST(Median, IsOfWhateverHasAnOrder) {
  using std::chrono::seconds;
  EXPECT_EQ(median(std::vector{seconds(9), seconds(1), seconds(2)}), seconds(2));
}

TEST(Median, RefusesNothing) {
  EXPECT_THROW(median(std::vector<double>{}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
