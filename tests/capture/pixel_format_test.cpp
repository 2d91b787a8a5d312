// SPDX-License-Identifier: Apache-2.0
#include "capture/pixel_format.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(PixelFormat, IsNamedAsGenICamDoes) {
  EXPECT_EQ(name_of({PixelKind::Grey, 12}), "Mono12");
  EXPECT_EQ(name_of({PixelKind::Bayer, 8, BayerPattern::GBRG}), "BayerGB8");
  EXPECT_EQ(name_of({PixelKind::Bgr}), "BGR8");
}

TEST(PixelFormat, ComesBackFromItsName) {
  for (const PixelKind kind : {PixelKind::Bgr, PixelKind::Yuyv, PixelKind::Nv12, PixelKind::Jpeg}) {
    EXPECT_EQ(parse_pixel_format(name_of({kind})), PixelFormat{kind});
  }
  for (const int bits : {8, 10, 12, 14, 16}) {
    const PixelFormat grey{PixelKind::Grey, bits}, bayer{PixelKind::Bayer, bits, BayerPattern::BGGR};
    EXPECT_EQ(parse_pixel_format(name_of(grey)), grey);
    EXPECT_EQ(parse_pixel_format(name_of(bayer)), bayer);
  }
  EXPECT_EQ(parse_pixel_format("bayerrg12"), (PixelFormat{PixelKind::Bayer, 12, BayerPattern::RGGB}));
}

TEST(PixelFormat, HasNoOtherNames) {
  for (const char* name : {"", "Mono", "Mono9", "BayerXX8", "mono8 "}) EXPECT_FALSE(parse_pixel_format(name)) << name;
}

TEST(PixelFormat, IsTheSameInAnyPatternUnlessItIsAMosaic) {
  EXPECT_EQ((PixelFormat{PixelKind::Grey, 8, BayerPattern::RGGB}),
            (PixelFormat{PixelKind::Grey, 8, BayerPattern::GRBG}));
  EXPECT_FALSE((PixelFormat{PixelKind::Bayer, 8, BayerPattern::RGGB}) ==
               (PixelFormat{PixelKind::Bayer, 8, BayerPattern::GRBG}));
}

TEST(PixelFormat, SaysHowItLiesInAMat) {
  EXPECT_EQ(mat_type({PixelKind::Bayer, 10}), CV_16UC1);
  EXPECT_EQ(mat_type({PixelKind::Yuyv}), CV_8UC2);
  EXPECT_EQ(mat_size({PixelKind::Nv12}, {640, 480}), cv::Size(640, 720));
  EXPECT_THROW(mat_type({PixelKind::Jpeg}), std::invalid_argument);
  EXPECT_THROW(mat_size({PixelKind::Jpeg}, {640, 480}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
