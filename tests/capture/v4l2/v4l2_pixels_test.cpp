// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_pixels.h"

#include <vector>

#include <gtest/gtest.h>
#include <linux/videodev2.h>

namespace alidade {
namespace {

using Bytes = std::vector<std::uint8_t>;

cv::Mat image_of(std::uint32_t code, cv::Size size, const Bytes& bytes, std::size_t stride) {
  const V4l2Plane plane{bytes, stride};
  return v4l2_image({&plane, 1}, *find_v4l2_format(code), size);
}

Bytes row_of(const cv::Mat& image, int y) {
  return {image.ptr(y), image.ptr(y) + image.cols * image.elemSize()};
}

TEST(V4l2Pixels, LeaveThePaddingOfRowsOut) {
  const cv::Mat image = image_of(V4L2_PIX_FMT_GREY, {3, 2}, {1, 2, 3, 99, 99, 4, 5, 6, 99, 99}, 5);
  ASSERT_EQ(image.type(), CV_8UC1);
  EXPECT_EQ(row_of(image, 0), (Bytes{1, 2, 3}));
  EXPECT_EQ(row_of(image, 1), (Bytes{4, 5, 6}));
}

TEST(V4l2Pixels, NeedNoPaddingBehindTheLastRow) {
  EXPECT_FALSE(image_of(V4L2_PIX_FMT_GREY, {3, 2}, {1, 2, 3, 99, 99, 4, 5, 6}, 5).empty());
}

TEST(V4l2Pixels, AreNoneWhereBytesAreMissing) {
  EXPECT_TRUE(image_of(V4L2_PIX_FMT_GREY, {3, 2}, {1, 2, 3, 99, 99, 4, 5}, 5).empty());
  EXPECT_TRUE(image_of(V4L2_PIX_FMT_GREY, {3, 2}, {}, 5).empty());
  EXPECT_TRUE(image_of(V4L2_PIX_FMT_GREY, {3, 1}, {1, 2, 3}, 2).empty());  // rows that overlap
  EXPECT_TRUE(image_of(V4L2_PIX_FMT_NV12, {2, 2}, {1, 2, 3, 4, 5}, 2).empty());
  EXPECT_TRUE(image_of(V4L2_PIX_FMT_MJPEG, {2, 2}, {}, 0).empty());
}

TEST(V4l2Pixels, HaveLumaFirstAndBlueFirst) {
  EXPECT_EQ(row_of(image_of(V4L2_PIX_FMT_YUYV, {2, 1}, {1, 2, 3, 4}, 4), 0), (Bytes{1, 2, 3, 4}));
  EXPECT_EQ(row_of(image_of(V4L2_PIX_FMT_UYVY, {2, 1}, {1, 2, 3, 4}, 4), 0), (Bytes{2, 1, 4, 3}));
  EXPECT_EQ(row_of(image_of(V4L2_PIX_FMT_BGR24, {2, 1}, {1, 2, 3, 4, 5, 6}, 6), 0), (Bytes{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(row_of(image_of(V4L2_PIX_FMT_RGB24, {2, 1}, {1, 2, 3, 4, 5, 6}, 6), 0), (Bytes{3, 2, 1, 6, 5, 4}));
}

TEST(V4l2Pixels, KeepValuesOfMoreThanEightBits) {
  EXPECT_EQ(image_of(V4L2_PIX_FMT_Y10, {1, 1}, {0x34, 0x02}, 2).at<std::uint16_t>(0, 0), 0x234);
  EXPECT_EQ(image_of(V4L2_PIX_FMT_Y16_BE, {1, 1}, {0x12, 0x34}, 2).at<std::uint16_t>(0, 0), 0x1234);
}

TEST(V4l2Pixels, UnpackFourTenBitValuesFromFiveBytes) {
  const cv::Mat image = image_of(V4L2_PIX_FMT_SBGGR10P, {4, 1}, {0xff, 0x00, 0x80, 0x01, 0b11'10'01'00}, 5);
  ASSERT_EQ(image.type(), CV_16UC1);
  const std::vector<std::uint16_t> expected{0x3fc, 0x001, 0x202, 0x007};
  EXPECT_EQ(std::vector<std::uint16_t>(image.begin<std::uint16_t>(), image.end<std::uint16_t>()), expected);
}

TEST(V4l2Pixels, TakeColourBehindLumaOrFromAPlaneOfItsOwn) {
  const Bytes together{1, 2, 99, 3, 4, 99, 5, 6, 99};
  const cv::Mat one = image_of(V4L2_PIX_FMT_NV12, {2, 2}, together, 3);
  ASSERT_EQ(one.size(), cv::Size(2, 3));
  EXPECT_EQ(row_of(one, 1), (Bytes{3, 4}));
  EXPECT_EQ(row_of(one, 2), (Bytes{5, 6}));

  const Bytes luma{1, 2, 3, 4};
  const Bytes colour{5, 6, 99, 99};
  const std::vector<V4l2Plane> planes{{luma, 2}, {colour, 4}};
  const cv::Mat two = v4l2_image(planes, *find_v4l2_format(V4L2_PIX_FMT_NV12M), {2, 2});
  for (int y = 0; y < 3; ++y) EXPECT_EQ(row_of(two, y), row_of(one, y));
}

TEST(V4l2Pixels, KeepTheBytesOfAJpeg) {
  EXPECT_EQ(row_of(image_of(V4L2_PIX_FMT_MJPEG, {640, 480}, {0xff, 0xd8, 7}, 0), 0), (Bytes{0xff, 0xd8, 7}));
}

TEST(V4l2Pixels, OutliveTheBuffer) {
  Bytes bytes{1, 2, 3};
  const cv::Mat image = image_of(V4L2_PIX_FMT_GREY, {3, 1}, bytes, 3);
  bytes.assign(3, 0);
  EXPECT_EQ(row_of(image, 0), (Bytes{1, 2, 3}));
}

}  // namespace
}  // namespace alidade
