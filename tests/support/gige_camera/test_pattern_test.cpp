// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/test_pattern.h"

#include <gtest/gtest.h>

#include "tests/support/gige_camera/payload_format.h"

namespace alidade::test {
namespace {

TEST(TestPattern, SpellsItsNumberInEveryFormat) {
  for (const PayloadFormat& format : payload_formats()) {
    for (const std::uint32_t number : {0U, 1U, 65536U, 0xdeadbeefU}) {
      EXPECT_EQ(number_in_pattern(test_pattern(number, {40, 3}, format.pixel), format.pixel), number) << format.name;
    }
  }
}

TEST(TestPattern, KeepsToTheBitsOfTheFormat) {
  double most = 0;
  cv::minMaxLoc(test_pattern(7, {200, 50}, {PixelKind::Grey, 10}), nullptr, &most);
  EXPECT_EQ(most, 1023);
}

// What a lost packet leaves behind is a part of an earlier picture.
TEST(TestPattern, SharesNoPartWithThePicturesBefore) {
  const cv::Mat now = test_pattern(100, {256, 128}, {});
  for (std::uint32_t before = 60; before < 100; ++before) {
    const cv::Mat is_equal = now == test_pattern(before, {256, 128}, {});
    for (int y = 0; y < now.rows; ++y) EXPECT_LT(cv::countNonZero(is_equal.row(y)), 40) << before << " row " << y;
  }
}

TEST(TestPattern, TellsNoNumberWhereTheRowIsTooShort) {
  EXPECT_EQ(number_in_pattern(test_pattern(1, {31, 2}, {}), {}), std::nullopt);
}

}  // namespace
}  // namespace alidade::test
