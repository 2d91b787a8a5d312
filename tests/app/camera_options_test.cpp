// SPDX-License-Identifier: Apache-2.0
#include "app/camera_options.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

std::string refusal(const CameraOptions& options) {
  try {
    validate(options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(CameraOptions, AskForNothingUntouched) {
  const CameraOptions options;
  EXPECT_NO_THROW(validate(options));
  const CameraRequest request = request_of(options);
  EXPECT_FALSE(request.size || request.offset || request.pixel_format || request.fps_hz || request.exposure_s ||
               request.gain || request.packet_size);
  EXPECT_TRUE(request.settings.empty());
  EXPECT_FALSE(live_options_of(options).give_up_s);
}

TEST(CameraOptions, AskForWhatTheySay) {
  CameraOptions options;
  options.size = "640x480";
  options.offset = "16,0";
  options.exposure_ms = 2.5;
  options.gain = "0";
  options.rate_hz = 30;
  const CameraRequest request = request_of(options);
  EXPECT_EQ(request.size, cv::Size(640, 480));
  EXPECT_EQ(request.offset, cv::Point(16, 0));
  EXPECT_DOUBLE_EQ(*request.exposure_s, 0.0025);
  EXPECT_EQ(request.gain, 0.0);
  EXPECT_EQ(request.fps_hz, 30.0);
}

TEST(CameraOptions, GiveACameraItsOwnSettingsAndThoseOfAll) {
  CameraOptions options;
  options.settings = {"ExposureAuto=Off", "left:Gain=3", "right:Gain=4", "Note=a=b:c"};
  const auto left = request_of(options, "left").settings;
  ASSERT_EQ(left.size(), 3u);
  EXPECT_EQ(left[1], (std::pair<std::string, std::string>("Gain", "3")));
  EXPECT_EQ(left[2], (std::pair<std::string, std::string>("Note", "a=b:c")));
}

TEST(CameraOptions, SayWhatWasWanted) {
  CameraOptions size, gain, setting, rate, trigger;
  size.size = "640*480";
  EXPECT_EQ(refusal(size), "camera.size must be WIDTHxHEIGHT in px like 640x480, got '640*480'");
  size.size = "640x0";
  EXPECT_NE(refusal(size), "");
  size.size = "640x480x3";
  EXPECT_NE(refusal(size), "");
  gain.gain = "high";
  EXPECT_EQ(refusal(gain), "camera.gain must be a number, got 'high'");
  setting.settings = {"Gain"};
  EXPECT_EQ(refusal(setting), "--set must be NAME=VALUE or CAMERA:NAME=VALUE, got 'Gain'");
  rate.rate_hz = -1;
  EXPECT_EQ(refusal(rate), "camera.rate_hz must be >= 0, got -1");
  trigger.trigger = CameraTrigger::Software;
  EXPECT_EQ(refusal(trigger), "camera.rate_hz must be > 0 for camera.trigger software, got 0");
}

TEST(CameraOptions, DoNotCallAHardwareTriggersSilenceAStall) {
  CameraOptions options;
  options.trigger = CameraTrigger::Hardware;
  EXPECT_TRUE(live_options_of(options).is_triggered);
}

}  // namespace
}  // namespace alidade
