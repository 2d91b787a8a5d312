// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/payload_format.h"

#include <gtest/gtest.h>

namespace alidade::test {
namespace {

Bytes payload_of(const cv::Mat& image, std::string_view name) {
  const PayloadFormat format = *find_payload_format(name);
  Bytes payload(payload_size(format, image.size()));
  write_payload(image, format, payload);
  return payload;
}

// PFNC, "Mono12Packed": the upper eight bits, both lower four, the upper eight. 0xabc, 0x123 and 0x456:
TEST(PayloadFormat, PacksTwoValuesOfTwelveBitsIntoThreeBytes) {
  const cv::Mat image = (cv::Mat_<std::uint16_t>(1, 3) << 0xabc, 0x123, 0x456);
  EXPECT_EQ(payload_of(image, "Mono12Packed"), (Bytes{0xab, 0x3c, 0x12, 0x45, 0x06}));
}

// 0x2ab = 10'1010'1011: upper 0xaa, lower 3; 0x155: upper 0x55, lower 1.
TEST(PayloadFormat, PacksTwoValuesOfTenBitsIntoThreeBytes) {
  const cv::Mat image = (cv::Mat_<std::uint16_t>(1, 2) << 0x2ab, 0x155);
  EXPECT_EQ(payload_of(image, "Mono10Packed"), (Bytes{0xaa, 0x13, 0x55}));
}

// "p": the lowest bit first, without a gap. 0xabc, 0x123 = bytes bc, 3a, 12.
TEST(PayloadFormat, LaysBitsSeamlessly) {
  const cv::Mat twelve = (cv::Mat_<std::uint16_t>(1, 2) << 0xabc, 0x123);
  EXPECT_EQ(payload_of(twelve, "Mono12p"), (Bytes{0xbc, 0x3a, 0x12}));
  const cv::Mat ten = (cv::Mat_<std::uint16_t>(2, 2) << 0x3ff, 0, 0x3ff, 0);
  EXPECT_EQ(payload_of(ten, "Mono10p"), (Bytes{0xff, 0x03, 0xf0, 0x3f, 0x00}));
}

TEST(PayloadFormat, SendsTheLowerByteFirstAndRedFirst) {
  EXPECT_EQ(payload_of((cv::Mat_<std::uint16_t>(1, 1) << 0x1234), "Mono16"), (Bytes{0x34, 0x12}));
  EXPECT_EQ(payload_of(cv::Mat(1, 1, CV_8UC3, cv::Scalar(1, 2, 3)), "RGB8"), (Bytes{3, 2, 1}));
  EXPECT_EQ(payload_of(cv::Mat(1, 1, CV_8UC3, cv::Scalar(1, 2, 3)), "BGR8"), (Bytes{1, 2, 3}));
}

TEST(PayloadFormat, NumberTellsTheSize) {
  for (const PayloadFormat& format : payload_formats()) {
    const std::size_t channels = format.pixel.kind == PixelKind::Bgr ? 3 : 1;
    const std::size_t least_bits = channels * static_cast<std::size_t>(format.pixel.bits);
    EXPECT_GE(payload_size(format, {8, 1}), least_bits) << format.name;
    EXPECT_EQ(find_payload_format(format.number)->name, format.name);
  }
}

}  // namespace
}  // namespace alidade::test
