// SPDX-License-Identifier: Apache-2.0
#include "io/natural_order.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(NaturalLess, CountsDigitsAsNumbers) {
  EXPECT_TRUE(natural_less("frame2.jpg", "frame10.jpg"));
  EXPECT_FALSE(natural_less("frame10.jpg", "frame2.jpg"));
  EXPECT_TRUE(natural_less("a9", "b1"));
  EXPECT_TRUE(natural_less("a", "a1"));
  EXPECT_TRUE(natural_less("2_9", "02_10"));
  EXPECT_FALSE(natural_less("7", "7"));
  EXPECT_NE(natural_less("07", "7"), natural_less("7", "07"));
  EXPECT_TRUE(natural_less("99999999999999999999998", "99999999999999999999999"));
}

}  // namespace
}  // namespace alidade
