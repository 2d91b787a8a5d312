// SPDX-License-Identifier: Apache-2.0
#include "app/targets/number_list.h"

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace alidade {
namespace {

std::string message_of(std::string_view text) {
  try {
    parse_numbers("delays_s", text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "fine";
}

TEST(NumberList, IsPartedByCommasWithBlanksOrWithout) {
  EXPECT_EQ(parse_numbers("delays_s", "0"), (std::vector<double>{0.0}));
  EXPECT_EQ(parse_numbers("delays_s", "0,-0.5, 2e-3 ,7"), (std::vector<double>{0.0, -0.5, 0.002, 7.0}));
}

TEST(NumberList, NamesTheOptionAndTheWordThatIsNoNumber) {
  EXPECT_EQ(message_of("0,x,1"), "delays_s must be numbers with commas between, got 'x'");
  EXPECT_EQ(message_of("0,1s"), "delays_s must be numbers with commas between, got '1s'");
  EXPECT_EQ(message_of("0;1"), "delays_s must be numbers with commas between, got '0;1'");
  EXPECT_EQ(message_of("1,nan"), "delays_s must be numbers with commas between, got 'nan'");
  for (const char* text : {"", "1,", ",1"}) {
    EXPECT_EQ(message_of(text), "delays_s must be numbers with commas between, got ''") << text;
  }
}

}  // namespace
}  // namespace alidade
