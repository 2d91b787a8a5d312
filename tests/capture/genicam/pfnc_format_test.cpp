// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/pfnc_format.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(PfncFormat, KnowsTheCodesOfTheStandard) {
  // Values of the GenICam Pixel Format Values list.
  EXPECT_EQ(pfnc_format(0x01080001)->name, "Mono8");
  EXPECT_EQ(pfnc_format(0x010C0006)->name, "Mono12Packed");
  EXPECT_EQ(pfnc_format(0x010A0046)->name, "Mono10p");
  EXPECT_EQ(pfnc_format(0x01100013)->name, "BayerBG12");
  EXPECT_EQ(pfnc_format(0x02180014)->name, "RGB8");
}

TEST(PfncFormat, IsEmptyForWhatCannotBeRead) {
  EXPECT_FALSE(pfnc_format(0x02200016));  // RGBa8
  EXPECT_FALSE(pfnc_format("Coord3D_ABC32f"));
  EXPECT_FALSE(pfnc_format(""));
}

TEST(PfncFormat, UnpacksIntoTheKindThatTheNameSays) {
  EXPECT_EQ(pfnc_format("Mono12Packed")->format, (PixelFormat{PixelKind::Grey, 12}));
  EXPECT_EQ(pfnc_format("BayerGB10p")->format, (PixelFormat{PixelKind::Bayer, 10, BayerPattern::GBRG}));
  EXPECT_EQ(pfnc_format("RGB8")->format, PixelFormat{PixelKind::Bgr});
  EXPECT_EQ(pfnc_format("YUV422_8_UYVY")->format, PixelFormat{PixelKind::Yuyv});
}

// Unpacked formats are named alike by GenICam and by us.
TEST(PfncFormat, AgreesWithOurOwnNamesOfUnpackedFormats) {
  for (const char* const name :
       {"Mono8", "Mono10", "Mono12", "Mono14", "Mono16", "BayerRG8", "BayerGR10", "BayerGB12", "BayerBG16", "BGR8"}) {
    ASSERT_TRUE(pfnc_format(name)) << name;
    EXPECT_EQ(parse_pixel_format(name), pfnc_format(name)->format) << name;
  }
}

TEST(PfncFormat, TakesNamesOfOlderCameras) {
  EXPECT_EQ(pfnc_format("RGB8Packed")->code, pfnc_format("RGB8")->code);
  EXPECT_EQ(pfnc_format("YUV422Packed")->code, pfnc_format("YUV422_8_UYVY")->code);
}

TEST(PfncFormat, CountsBytesWithTheLastOneFilledUp) {
  EXPECT_EQ(wire_bytes(*pfnc_format("Mono8"), 7), 7u);
  EXPECT_EQ(wire_bytes(*pfnc_format("Mono16"), 7), 14u);
  EXPECT_EQ(wire_bytes(*pfnc_format("Mono12Packed"), 7), 11u);  // 84 bits
  EXPECT_EQ(wire_bytes(*pfnc_format("Mono10p"), 7), 9u);        // 70 bits
  EXPECT_EQ(wire_bytes(*pfnc_format("Mono10Packed"), 2), 3u);   // spaced to 12 bits
  EXPECT_EQ(wire_bytes(*pfnc_format("RGB8"), 7), 21u);
}

}  // namespace
}  // namespace alidade
