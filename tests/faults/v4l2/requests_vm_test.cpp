// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "capture/v4l2/v4l2_camera.h"
#include "capture/v4l2/v4l2_controls.h"
#include "capture/v4l2/v4l2_listing.h"
#include "tests/faults/v4l2/vivid.h"

namespace alidade::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class V4l2RequestsInTheMachine : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_vivid()) GTEST_SKIP() << "no vivid here";
  }
};

struct Complaint {
  CameraTrouble trouble;
  std::string text;
};

Complaint complaint(const std::string& path, const CameraRequest& request) {
  try {
    open_v4l2(path, request);
  } catch (const CameraError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return {error.trouble(), error.what()};
  }
  ADD_FAILURE() << path << " opened";
  return {};
}

TEST_F(V4l2RequestsInTheMachine, ListCamerasWithAllThatTheyOffer) {
  const std::vector<ListedCamera> cameras = list_v4l2();
  ASSERT_EQ(cameras.size(), 3U);  // the output is none
  EXPECT_EQ(cameras[0].source, "v4l2:/dev/video0");
  EXPECT_EQ(cameras[0].driver, "vivid");
  EXPECT_EQ(cameras[0].trouble, "");
  ASSERT_FALSE(cameras[0].formats.empty());
  const ListedFormat& yuyv = cameras[0].formats[0];
  EXPECT_EQ(yuyv.name, "YUYV");
  EXPECT_EQ(yuyv.description, "YUYV 4:2:2");
  ASSERT_GE(yuyv.sizes.size(), 4U);
  EXPECT_EQ(yuyv.sizes[0].size, cv::Size(320, 180));
  EXPECT_DOUBLE_EQ(yuyv.sizes[0].fps_hz.front(), 60);
  EXPECT_DOUBLE_EQ(yuyv.sizes[0].fps_hz.back(), 1);
  EXPECT_TRUE(cameras[2].formats[0].sizes[0].least);  // HDMI offers a range

  const auto control = [&](const std::string& name) {
    for (const ListedControl& candidate : cameras[0].controls) {
      if (candidate.name == name) return candidate;
    }
    ADD_FAILURE() << "no control " << name;
    return ListedControl{};
  };
  EXPECT_EQ(control("brightness").range, "0 to 255 by 1");
  EXPECT_EQ(control("brightness").value, "128");
  EXPECT_EQ(control("menu").choices, (std::vector<std::string>{"Menu Item 1", "Menu Item 3", "Menu Item 4"}));
  EXPECT_EQ(control("disconnect").kind, "command");
  EXPECT_EQ(control("string").kind, "text");
  EXPECT_FALSE(control("read_only_integer_32_bits").is_writable);
}

TEST_F(V4l2RequestsInTheMachine, RefuseASizeThatIsNotOffered) {
  CameraRequest request;
  request.size = cv::Size(333, 222);
  const Complaint said = complaint(kWebcam, request);
  EXPECT_EQ(said.trouble, CameraTrouble::Refused);
  EXPECT_NE(said.text.find("/dev/video0: set the format: 333x222 is not offered; offered are YUYV, UYVY"),
            std::string::npos)
      << said.text;
  EXPECT_NE(said.text.find("320x180, 640x360"), std::string::npos) << said.text;
}

TEST_F(V4l2RequestsInTheMachine, RefuseAFormatThatIsNotOffered) {
  CameraRequest request = small_request();
  for (const char* format : {"MJPG", "YU12", "nonsense"}) {
    request.pixel_format = format;
    const Complaint said = complaint(kWebcam, request);
    EXPECT_EQ(said.trouble, CameraTrouble::Refused);
    EXPECT_NE(said.text.find(std::string(format) + " at 320x180 is not offered; offered are"), std::string::npos)
        << said.text;
  }
}

TEST_F(V4l2RequestsInTheMachine, RefuseAnOutput) {
  const Complaint said = complaint(kLoopOutput, {});
  EXPECT_EQ(said.trouble, CameraTrouble::Refused);
  EXPECT_NE(said.text.find("it does not capture video"), std::string::npos) << said.text;
}

TEST_F(V4l2RequestsInTheMachine, RefuseAnExposureThatTheCameraDoesNotHave) {
  CameraRequest request = small_request();
  request.exposure_s = 0.01;
  EXPECT_EQ(complaint(kWebcam, request).trouble, CameraTrouble::Refused);
}

TEST_F(V4l2RequestsInTheMachine, AreBusyWhileAnotherStreams) {
  const auto first = open_v4l2(kWebcam, small_request());
  const Complaint said = complaint(kWebcam, small_request());
  EXPECT_EQ(said.trouble, CameraTrouble::Busy);
  EXPECT_NE(said.text.find("in use by another program"), std::string::npos) << said.text;
  EXPECT_TRUE(first->wait(seconds(2)));  // not disturbed
}

TEST_F(V4l2RequestsInTheMachine, SetControlsByName) {
  CameraRequest request = small_request();
  request.settings = {{"brightness", "77"},
                      {"menu", "menu_item_4"},
                      {"boolean", "off"},
                      {"string", "abc"},
                      {"integer_64_bits", "-5000000000"}};
  request.gain = 55;
  const auto camera = open_v4l2(kWebcam, request);
  std::map<std::string, std::string> now;
  for (const ListedControl& control : list_v4l2_controls(V4l2Device(kWebcam))) now[control.name] = control.value;
  EXPECT_EQ(now["brightness"], "77");
  EXPECT_EQ(now["menu"], "Menu Item 4");
  EXPECT_EQ(now["boolean"], "0");
  EXPECT_EQ(now["string"], "abc");
  EXPECT_EQ(now["integer_64_bits"], "-5000000000");
  EXPECT_EQ(now["gain"], "55");
  EXPECT_EQ(now["gain_automatic"], "0");
  set_control(kWebcam, "brightness", "128");
}

TEST_F(V4l2RequestsInTheMachine, NameTheNearestControl) {
  CameraRequest request = small_request();
  request.settings = {{"brightnes", "77"}};
  EXPECT_EQ(complaint(kWebcam, request).text,
            "/dev/video0: set brightnes: the camera has no such control; did you mean 'brightness'?");
  request.settings = {{"read_only_integer_32_bits", "7"}};
  EXPECT_EQ(complaint(kWebcam, request).trouble, CameraTrouble::Refused);
}

TEST_F(V4l2RequestsInTheMachine, AreReadBackAndKept) {
  const WebcamReset reset;
  for (const auto& [source, moment] :
       {std::pair{"End of Frame", StampedMoment::ReadoutEnd}, {"Start of Exposure", StampedMoment::ExposureStart}}) {
    CameraRequest request = small_request(25);
    request.settings = {{"timestamp_source", source}};
    const auto camera = open_v4l2(kWebcam, request);
    EXPECT_EQ(camera->facts().stamped, moment);
    EXPECT_TRUE(camera->facts().is_host_clock);
    EXPECT_EQ(camera->facts().size, cv::Size(320, 180));
    EXPECT_EQ(camera->facts().device_format, "GREY");  // what serves tracking best
    EXPECT_EQ(camera->facts().period, milliseconds(40));
    std::vector<Timestamp> times;
    for (int i = 0; i < 26; ++i) {
      const auto frame = camera->wait(seconds(2));
      ASSERT_TRUE(frame);
      times.push_back(*frame->stamp.device_time);
    }
    const double period_s = to_seconds(times.back() - times.front()) / 25;
    EXPECT_NEAR(period_s, 0.04, 0.006);  // the machine may drop a frame
  }
}

}  // namespace
}  // namespace alidade::test
