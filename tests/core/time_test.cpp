// SPDX-License-Identifier: Apache-2.0
#include "core/time.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

using namespace std::chrono_literals;

TEST(ParseSeconds, KeepsEveryNanosecond) {
  EXPECT_EQ(parse_seconds("1305031229.528748"), Timestamp(1305031229528748000ns));
  EXPECT_EQ(parse_seconds("0.000000001"), Timestamp(1ns));
  EXPECT_EQ(parse_seconds("-1.5"), Timestamp(-1500000000ns));
  EXPECT_EQ(parse_seconds("7"), Timestamp(7s));
}

TEST(ParseSeconds, TakesExponents) {
  EXPECT_EQ(parse_seconds("1e3"), Timestamp(1000s));
  EXPECT_EQ(parse_seconds("0.000000e+00"), Timestamp(0s));
  EXPECT_EQ(parse_seconds("1.035600e-01"), Timestamp(103560000ns));
}

TEST(ParseSeconds, IsEmptyForWhatIsNoNumberOrDoesNotFit) {
  for (const char* text :
       {"", "-", "abc", "1.2.3", "1.-5", "--1", " 1", "1 ", "nan", "inf", "1e", "1e300", "99999999999"})
    EXPECT_FALSE(parse_seconds(text)) << "'" << text << "'";
}

TEST(FormatSeconds, IsReadBackAsTheSameMoment) {
  for (const auto count : {0ns, 1ns, -1ns, 999999999ns, -1000000001ns, 1305031229528748001ns}) {
    const Timestamp time(count);
    EXPECT_EQ(parse_seconds(format_seconds(time)), time) << format_seconds(time);
  }
  EXPECT_EQ(format_seconds(Timestamp(-1500ms)), "-1.500000000");
}

TEST(FromSeconds, RoundsToTheNearestNanosecond) {
  EXPECT_EQ(from_seconds(0.1), 100000000ns);
  EXPECT_EQ(from_seconds(-1.0000000006), -1000000001ns);
  EXPECT_DOUBLE_EQ(to_seconds(from_seconds(12.25)), 12.25);
}

}  // namespace
}  // namespace alidade
