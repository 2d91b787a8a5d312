// SPDX-License-Identifier: Apache-2.0
#include "app/camera_listing_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

using testing::ElementsAre;

ListedCamera camera() {
  ListedCamera camera;
  camera.source = "v4l2:/dev/video0";
  camera.aliases = {"v4l2:/dev/v4l/by-id/usb-cam"};
  camera.model = "Cam";
  camera.serial = "7";
  camera.driver = "uvcvideo";
  camera.formats = {{"YUYV", "YUYV 4:2:2", true, {{{640, 480}, {}, {30, 15}}, {{320, 240}, {}, {60}}}},
                    {"H264", "H.264", false, {{{1920, 1080}, cv::Size(16, 16), {}}}}};
  camera.controls = {{"gain", "integer", "3", "0 to 9 by 1", {}, "dB", true},
                     {"auto", "choice", "Off", "", {"Off", "On"}, "", false}};
  return camera;
}

TEST(CameraListingText, SaysInFewLinesWhatACameraIs) {
  EXPECT_THAT(lines_of(camera(), false),
              ElementsAre("v4l2:/dev/video0  Cam, serial 7, by uvcvideo", "  also v4l2:/dev/v4l/by-id/usb-cam",
                          "  YUYV: 640x480 at 30, 15 Hz, and 1 more size",
                          "  H264, not one that alidade reads: 16x16 to 1920x1080"));
}

TEST(CameraListingText, SaysEverythingWhereItIsAsked) {
  EXPECT_THAT(lines_of(camera(), true),
              ElementsAre("v4l2:/dev/video0  Cam, serial 7, by uvcvideo", "  also v4l2:/dev/v4l/by-id/usb-cam",
                          "  YUYV (YUYV 4:2:2)", "    640x480 at 30, 15 Hz", "    320x240 at 60 Hz",
                          "  H264 (H.264), not one that alidade reads", "    16x16 to 1920x1080", "  for --set:",
                          "    gain = 3 dB  (integer, 0 to 9 by 1)", "    auto = Off  (choice, read only): Off, On"));
}

TEST(CameraListingText, SaysWhyACameraCannotBeAsked) {
  ListedCamera busy;
  busy.source = "v4l2:/dev/video1";
  busy.trouble = "in use";
  EXPECT_THAT(lines_of(busy, true), ElementsAre("v4l2:/dev/video1", "  cannot be asked: in use"));
  EXPECT_EQ(to_json(busy)["trouble"], "in use");
}

TEST(CameraListingText, GivesNumbersAsNumbers) {
  const nlohmann::json json = to_json(camera());
  EXPECT_EQ(json["formats"][0]["sizes"][0]["rates_hz"], (std::vector<double>{30, 15}));
  EXPECT_EQ(json["formats"][1]["sizes"][0]["least_px"], (std::vector<int>{16, 16}));
  EXPECT_EQ(json["controls"][1]["choices"], (std::vector<std::string>{"Off", "On"}));
  EXPECT_FALSE(json.contains("trouble"));
}

}  // namespace
}  // namespace alidade
