// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_formats.h"

#include <set>

#include <gtest/gtest.h>
#include <linux/videodev2.h>

namespace alidade {
namespace {

TEST(V4l2Formats, AreListedOnce) {
  std::set<std::uint32_t> codes;
  for (const V4l2Format& format : v4l2_formats()) EXPECT_TRUE(codes.insert(format.code).second) << format.code;
  EXPECT_GE(codes.size(), 30U);
}

TEST(V4l2Formats, KeepTheirCodeThroughTheirName) {
  for (const V4l2Format& format : v4l2_formats()) {
    EXPECT_EQ(parse_v4l2_format_name(v4l2_format_name(format.code)), format.code) << v4l2_format_name(format.code);
    EXPECT_EQ(find_v4l2_format(format.code), &format);
  }
}

TEST(V4l2Formats, AreNamedByTheirCharacters) {
  EXPECT_EQ(v4l2_format_name(V4L2_PIX_FMT_YUYV), "YUYV");
  EXPECT_EQ(v4l2_format_name(V4L2_PIX_FMT_Y10), "Y10");
  EXPECT_EQ(v4l2_format_name(V4L2_PIX_FMT_Y16_BE), "Y16-BE");
}

TEST(V4l2Formats, AreFoundInLowerCaseToo) {
  EXPECT_EQ(parse_v4l2_format_name("yuyv"), V4L2_PIX_FMT_YUYV);
  EXPECT_EQ(parse_v4l2_format_name("pBAA"), V4L2_PIX_FMT_SBGGR10P);
  EXPECT_EQ(parse_v4l2_format_name("H264"), V4L2_PIX_FMT_H264);  // known to V4L2, if not to us
  EXPECT_FALSE(parse_v4l2_format_name(""));
  EXPECT_FALSE(parse_v4l2_format_name("Mono8"));
}

TEST(V4l2Formats, AreUnknownWhereWeCannotReadThem) {
  EXPECT_EQ(find_v4l2_format(V4L2_PIX_FMT_H264), nullptr);
}

TEST(V4l2Formats, PutJpegBehindAllThatLosesNothing) {
  bool is_behind = false;
  for (const V4l2Format& format : v4l2_formats()) {
    const bool is_jpeg = format.pixels.kind == PixelKind::Jpeg;
    EXPECT_FALSE(is_behind && !is_jpeg) << v4l2_format_name(format.code);
    is_behind = is_jpeg;
  }
  EXPECT_TRUE(is_behind);
}

TEST(V4l2Formats, HaveRowsOfTheirLength) {
  EXPECT_EQ(v4l2_row_bytes(*find_v4l2_format(V4L2_PIX_FMT_GREY), 6), 6U);
  EXPECT_EQ(v4l2_row_bytes(*find_v4l2_format(V4L2_PIX_FMT_YUYV), 6), 12U);
  EXPECT_EQ(v4l2_row_bytes(*find_v4l2_format(V4L2_PIX_FMT_RGB24), 6), 18U);
  EXPECT_EQ(v4l2_row_bytes(*find_v4l2_format(V4L2_PIX_FMT_Y12), 6), 12U);
  EXPECT_EQ(v4l2_row_bytes(*find_v4l2_format(V4L2_PIX_FMT_NV12), 6), 6U);
  EXPECT_EQ(v4l2_row_bytes(*find_v4l2_format(V4L2_PIX_FMT_Y10P), 8), 10U);
  EXPECT_EQ(v4l2_row_bytes(*find_v4l2_format(V4L2_PIX_FMT_Y10P), 6), 10U);  // of whole groups of four
}

}  // namespace
}  // namespace alidade
