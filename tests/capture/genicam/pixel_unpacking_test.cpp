// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/pixel_unpacking.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace alidade {
namespace {

std::vector<int> values_of(const cv::Mat& image) {
  std::vector<int> values;
  for (int row = 0; row < image.rows; ++row) {
    for (int i = 0; i < image.cols * image.channels(); ++i) {
      values.push_back(image.depth() == CV_16U ? image.ptr<std::uint16_t>(row)[i] : image.ptr<std::uint8_t>(row)[i]);
    }
  }
  return values;
}

std::vector<int> unpacked(const char* format, const std::vector<std::uint8_t>& bytes, cv::Size size,
                          std::size_t padding = 0) {
  return values_of(unpack_image(bytes, *pfnc_format(format), size, padding));
}

// Bits of `values`, the lowest first, as a stream of bytes: what PFNC calls "p", written from its definition.
std::vector<std::uint8_t> lsb_stream(const std::vector<int>& values, int bits) {
  std::vector<std::uint8_t> bytes((values.size() * static_cast<std::size_t>(bits) + 7) / 8);
  std::size_t at = 0;
  for (const int value : values) {
    for (int bit = 0; bit < bits; ++bit, ++at) {
      if (value >> bit & 1) bytes[at / 8] = static_cast<std::uint8_t>(bytes[at / 8] | 1 << at % 8);
    }
  }
  return bytes;
}

std::vector<int> random_values(int bits, std::size_t count) {
  std::mt19937 random(7);
  std::vector<int> values(count);
  for (int& value : values) value = static_cast<int>(random() & ((1u << bits) - 1));
  return values;
}

TEST(PixelUnpacking, CopiesBytesAndLittleEndianWords) {
  EXPECT_EQ(unpacked("Mono8", {1, 2, 3, 255}, {2, 2}), (std::vector<int>{1, 2, 3, 255}));
  EXPECT_EQ(unpacked("Mono12", {0xBC, 0x0A, 0x01, 0x00}, {2, 1}), (std::vector<int>{0xABC, 1}));
  EXPECT_EQ(unpacked("BayerRG16", {0xCD, 0xAB}, {1, 1}), (std::vector<int>{0xABCD}));
}

// GigE Vision's Mono12Packed: upper byte of one, both lower halves (of the second above), upper byte of the other.
TEST(PixelUnpacking, ReadsTwelveBitsAsGigeVisionPacksThem) {
  EXPECT_EQ(unpacked("Mono12Packed", {0xAB, 0xFC, 0xDE}, {2, 1}), (std::vector<int>{0xABC, 0xDEF}));
  EXPECT_EQ(unpacked("BayerGR12Packed", {0x12, 0x63, 0x45, 0x78, 0x09}, {3, 1}),
            (std::vector<int>{0x123, 0x456, 0x789}));
}

// Mono10Packed: the lower two bits of the values are bits 0 to 1 and 4 to 5 of the middle byte.
TEST(PixelUnpacking, ReadsTenBitsAsGigeVisionPacksThem) {
  EXPECT_EQ(unpacked("Mono10Packed", {0xFF, 0x12, 0x00}, {2, 1}), (std::vector<int>{0x3FE, 0x001}));
  EXPECT_EQ(unpacked("Mono10Packed", {0x00, 0x21, 0xFF}, {2, 1}), (std::vector<int>{0x001, 0x3FE}));
}

TEST(PixelUnpacking, ReadsStreamsOfBitsOfEverySize) {
  for (int width = 1; width <= 9; ++width) {
    const auto count = static_cast<std::size_t>(width * 3);
    const auto ten = random_values(10, count), twelve = random_values(12, count);
    EXPECT_EQ(unpacked("Mono10p", lsb_stream(ten, 10), {width, 3}), ten) << width;
    EXPECT_EQ(unpacked("BayerBG12p", lsb_stream(twelve, 12), {width, 3}), twelve) << width;
  }
}

TEST(PixelUnpacking, PutsBlueFirstAndLumaFirst) {
  EXPECT_EQ(unpacked("RGB8", {1, 2, 3, 4, 5, 6}, {2, 1}), (std::vector<int>{3, 2, 1, 6, 5, 4}));
  EXPECT_EQ(unpacked("BGR8", {1, 2, 3}, {1, 1}), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(unpacked("YUV422_8", {1, 2, 3, 4}, {2, 1}), (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(unpacked("YUV422_8_UYVY", {1, 2, 3, 4}, {2, 1}), (std::vector<int>{2, 1, 4, 3}));
}

TEST(PixelUnpacking, SkipsThePaddingOfRows) {
  EXPECT_EQ(unpacked("Mono8", {1, 2, 99, 3, 4, 99}, {2, 2}, 1), (std::vector<int>{1, 2, 3, 4}));
  // A row of one value takes two bytes, and two of padding.
  EXPECT_EQ(unpacked("Mono12p", {0x34, 0x02, 99, 99, 0x78, 0x06, 99, 99}, {1, 2}, 2), (std::vector<int>{0x234, 0x678}));
}

TEST(PixelUnpacking, IsEmptyWhereBytesAreMissing) {
  const std::vector<std::uint8_t> bytes(11);
  EXPECT_EQ(wire_image_bytes(*pfnc_format("Mono12Packed"), {4, 2}), 12u);
  EXPECT_TRUE(unpack_image(bytes, *pfnc_format("Mono12Packed"), {4, 2}).empty());
  EXPECT_TRUE(unpack_image({}, *pfnc_format("Mono8"), {1, 1}).empty());
}

TEST(PixelUnpacking, GivesTheTypeThatTheFormatSays) {
  for (const char* const name : {"Mono8", "Mono10p", "BayerRG12Packed", "RGB8", "YUV422_8"}) {
    const PfncFormat format = *pfnc_format(name);
    const std::vector<std::uint8_t> bytes(wire_image_bytes(format, {8, 4}));
    const cv::Mat image = unpack_image(bytes, format, {8, 4});
    EXPECT_EQ(image.type(), mat_type(format.format)) << name;
    EXPECT_EQ(image.size(), cv::Size(8, 4)) << name;
  }
}

}  // namespace
}  // namespace alidade
