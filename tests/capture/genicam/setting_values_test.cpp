// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/setting_values.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(SettingValues, ReadsIntegersInTensAndSixteens) {
  EXPECT_EQ(parse_integer_setting("-12"), -12);
  EXPECT_EQ(parse_integer_setting("0x1F"), 31);
  EXPECT_EQ(parse_integer_setting("9223372036854775807"), INT64_MAX);
}

TEST(SettingValues, RefusesWhatIsNoInteger) {
  for (const char* const text : {"", "1.5", "12px", " 1", "0x", "0x-1", "9223372036854775808", "one"}) {
    EXPECT_FALSE(parse_integer_setting(text)) << text;
  }
}

TEST(SettingValues, ReadsFiniteNumbersOnly) {
  EXPECT_EQ(parse_float_setting("1e-3"), 1e-3);
  EXPECT_EQ(parse_float_setting("-7"), -7);
  for (const char* const text : {"", "nan", "inf", "1,5", "3 ms"}) EXPECT_FALSE(parse_float_setting(text)) << text;
}

TEST(SettingValues, ReadsTheWordsForTrueAndFalse) {
  for (const char* const text : {"true", "On", "YES", "1"}) EXPECT_EQ(parse_boolean_setting(text), true) << text;
  for (const char* const text : {"false", "Off", "no", "0"}) EXPECT_EQ(parse_boolean_setting(text), false) << text;
  for (const char* const text : {"", "2", "truth"}) EXPECT_FALSE(parse_boolean_setting(text)) << text;
}

}  // namespace
}  // namespace alidade
