// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/camera_setup.h"

#include <utility>
#include <vector>

#include <arv.h>
#include <gtest/gtest.h>

namespace alidade {
namespace {

using namespace std::chrono_literals;

CameraRequest with_settings(std::vector<std::pair<std::string, std::string>> settings) {
  CameraRequest request;
  request.settings = std::move(settings);
  return request;
}

CameraRequest with_rate(double fps_hz) {
  CameraRequest request;
  request.fps_hz = fps_hz;
  return request;
}

CameraRequest triggered(CameraTrigger trigger) {
  CameraRequest request;
  request.trigger = trigger;
  return request;
}

// Aravis' camera within this process, with features added where a test needs them.
class CameraSettingUp : public testing::Test {
 protected:
  CameraSettingUp() : device_(arv_fake_device_new("T1", nullptr)) {
    camera_.reset(arv_camera_new_with_device(device_.get(), nullptr));
  }

  CameraSetup set_up(const CameraRequest& request) const { return set_up_camera(camera_.get(), request, "genicam:x"); }

  std::string refusal(const CameraRequest& request) const {
    try {
      set_up(request);
    } catch (const CameraError& error) {
      return error.what();
    }
    return "";
  }

  void add(const char* name, const std::string& description) const {
    arv_gc_set_default_node_data(arv_device_get_genicam(device_.get()), name, description.c_str(), nullptr);
  }

  std::string feature(const char* name) const {
    const char* const value = arv_device_get_string_feature_value(device_.get(), name, nullptr);
    return value ? value : "";
  }

  GObjectPointer<ArvDevice> device_;
  GObjectPointer<ArvCamera> camera_;
};

TEST_F(CameraSettingUp, PutsTheRegionWhereItIsWanted) {
  CameraRequest request;
  request.size = cv::Size(320, 200);
  request.offset = cv::Point(16, 8);
  EXPECT_EQ(set_up(request).facts.size, cv::Size(320, 200));
  EXPECT_EQ(arv_device_get_integer_feature_value(device_.get(), "OffsetX", nullptr), 16);
  EXPECT_EQ(arv_device_get_integer_feature_value(device_.get(), "OffsetY", nullptr), 8);
}

TEST_F(CameraSettingUp, SwitchesTheAutomaticsOffWhenGivenAValue) {
  set_up(with_settings({{"GainAuto", "Continuous"}}));
  EXPECT_EQ(feature("GainAuto"), "Continuous");
  CameraRequest request;
  request.gain = 4;
  set_up(request);
  EXPECT_EQ(feature("GainAuto"), "Off");
}

TEST_F(CameraSettingUp, TakesPrecisionTimeWhereThereIsSome) {
  EXPECT_EQ(set_up({}).facts.clock, "camera");
  add("GevIEEE1588", "<Boolean Name=\"GevIEEE1588\"><Value>0</Value></Boolean>");
  EXPECT_EQ(set_up({}).facts.clock, "PTP");
  EXPECT_TRUE(arv_device_get_boolean_feature_value(device_.get(), "GevIEEE1588", nullptr));
}

TEST_F(CameraSettingUp, LeavesPrecisionTimeOffWhereTheUserWantsThat) {
  add("GevIEEE1588", "<Boolean Name=\"GevIEEE1588\"><Value>0</Value></Boolean>");
  EXPECT_EQ(set_up(with_settings({{"GevIEEE1588", "false"}})).facts.clock, "camera");
}

TEST_F(CameraSettingUp, BelievesTheRateThatTheCameraSaysItReaches) {
  EXPECT_EQ(set_up(with_rate(100)).facts.period, 10ms);
  add("ResultingFrameRate", "<Float Name=\"ResultingFrameRate\"><Value>40</Value></Float>");
  EXPECT_EQ(set_up(with_rate(100)).facts.period, 25ms);
}

TEST_F(CameraSettingUp, TriggersBySoftwareAtTheRateOfTheHost) {
  CameraRequest request = triggered(CameraTrigger::Software);
  request.fps_hz = 20;
  EXPECT_EQ(set_up(request).facts.period, 50ms);
  EXPECT_EQ(feature("TriggerMode"), "On");
  EXPECT_EQ(feature("TriggerSource"), "Software");
}

TEST_F(CameraSettingUp, TriggersByALineOfTheCamera) {
  EXPECT_FALSE(set_up(triggered(CameraTrigger::Hardware)).facts.period);
  EXPECT_EQ(feature("TriggerMode"), "On");
  EXPECT_EQ(feature("TriggerSource"), "Line0");
}

TEST_F(CameraSettingUp, RunsFreelyAfterATriggerUnlessTheUserSetOne) {
  set_up(triggered(CameraTrigger::Software));
  set_up({});
  EXPECT_EQ(feature("TriggerMode"), "Off");
  CameraRequest request = with_settings({{"TriggerMode", "On"}, {"TriggerSource", "Line0"}});
  request.fps_hz = 20;
  set_up(request);
  EXPECT_EQ(feature("TriggerMode"), "On");
}

TEST_F(CameraSettingUp, RefusesAFormatThatCannotBeReadAndNamesTheOthers) {
  arv_device_set_integer_feature_value(device_.get(), "PixelFormatRegister", 0x02200016, nullptr);  // RGBa8
  EXPECT_EQ(refusal({}),
            "genicam:x: choose the pixel format: its format cannot be read; ask for BayerBG8, BayerGB8, BayerGR8, "
            "BayerRG8, Mono8, RGB8, Mono16");
}

}  // namespace
}  // namespace alidade
