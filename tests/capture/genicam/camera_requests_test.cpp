// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "capture/genicam/genicam_camera.h"
#include "fake_camera_process.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

// What a request becomes, seen from outside: one camera serves all of these tests.
class CameraRequests : public testing::Test {
 protected:
  static void SetUpTestSuite() { process_ = std::make_unique<FakeCameraProcess>(); }
  static void TearDownTestSuite() { process_.reset(); }
  void SetUp() override {
    if (!process_->is_running()) GTEST_SKIP() << "no camera on loopback";
    request_.size = cv::Size(64, 32);
    request_.offset = cv::Point(0, 0);
    request_.pixel_format = "Mono8";
    request_.fps_hz = 500;
  }

  std::unique_ptr<CameraDevice> open() const { return open_genicam(FakeCameraProcess::address(), request_); }

  CameraFacts granted() const { return open()->facts(); }

  std::string refusal() const {
    try {
      open();
    } catch (const CameraError& error) {
      EXPECT_EQ(error.trouble(), CameraTrouble::Refused);
      const std::string prefix = "genicam:127.0.0.1: ";
      EXPECT_TRUE(std::string(error.what()).starts_with(prefix));
      return std::string(error.what()).substr(prefix.size());
    }
    return "";
  }

  static std::unique_ptr<FakeCameraProcess> process_;
  CameraRequest request_;
};

std::unique_ptr<FakeCameraProcess> CameraRequests::process_;

TEST_F(CameraRequests, IsReadBack) {
  request_.exposure_s = 0.001;
  request_.gain = 3;
  const CameraFacts facts = granted();
  EXPECT_EQ(facts.source, "genicam:127.0.0.1");
  EXPECT_EQ(facts.model, "Aravis Fake");
  EXPECT_EQ(facts.serial, "T1");
  EXPECT_EQ(facts.size, cv::Size(64, 32));
  EXPECT_EQ(facts.format, PixelFormat{});
  EXPECT_EQ(facts.device_format, "Mono8");
  EXPECT_EQ(facts.period, 2ms);
  EXPECT_EQ(facts.exposure, 1ms);
  EXPECT_EQ(facts.clock, "camera");
  EXPECT_FALSE(facts.is_host_clock);
}

TEST_F(CameraRequests, LeavesWhatIsNotAskedFor) {
  granted();
  request_ = {};
  const CameraFacts facts = granted();
  EXPECT_EQ(facts.size, cv::Size(64, 32));
  EXPECT_EQ(facts.period, 2ms);
}

TEST_F(CameraRequests, ReadsEveryFormatOfTheCamera) {
  for (const char* const name : {"Mono8", "Mono16", "RGB8", "BayerBG8", "BayerGB8", "BayerGR8", "BayerRG8"}) {
    request_.pixel_format = name;
    const auto camera = open();
    EXPECT_EQ(camera->facts().device_format, name);
    const auto frame = camera->wait(2s);
    ASSERT_TRUE(frame) << name;
    EXPECT_EQ(frame->format, camera->facts().format);
    EXPECT_EQ(frame->image.type(), mat_type(frame->format)) << name;
    EXPECT_FALSE(frame->stamp.is_damaged);
  }
}

TEST_F(CameraRequests, TakesBlocksOfLines) {
  for (const int lines : {1, 3}) {
    request_.size = cv::Size(2048, lines);
    const auto camera = open();
    const auto frame = camera->wait(2s);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->image.size(), cv::Size(2048, lines));
    EXPECT_FALSE(frame->stamp.is_damaged);
  }
}

TEST_F(CameraRequests, SetsFeaturesByNameBeforeAllElse) {
  request_.settings = {{"Width", "100"}, {"GainAuto", "Continuous"}};
  EXPECT_EQ(granted().size, cv::Size(64, 32));
  request_.size.reset();
  EXPECT_EQ(granted().size, cv::Size(100, 32));
}

TEST_F(CameraRequests, RefusesWhatTheCameraHasNot) {
  request_.size = cv::Size(4096, 32);
  EXPECT_EQ(refusal(), "set Width=4096: is out of range; it takes 1 to 2048");
  request_.size = cv::Size(64, 32);
  request_.fps_hz = 5000;
  EXPECT_EQ(refusal(), "set the frame rate: 5000 Hz is out of range; it takes 0.1 to 1000 Hz");
  request_.fps_hz = 100;
  request_.gain = 11;
  EXPECT_EQ(refusal(), "set the gain: 11 (the camera's unit) is out of range; it takes 0 to 10 (the camera's unit)");
  request_.gain.reset();
  request_.exposure_s = 3600;
  EXPECT_TRUE(refusal().starts_with("set the exposure: 3.6e+09 us is out of range; it takes "));
  request_.exposure_s.reset();
  request_.pixel_format = "Mono12Packed";
  EXPECT_TRUE(refusal().starts_with("set PixelFormat=Mono12Packed: is none of its choices; it takes "));
}

TEST_F(CameraRequests, SaysThatNothingCameOfAnUnknownFeature) {
  request_.settings = {{"GainAutp", "Off"}};
  EXPECT_EQ(refusal(), "set GainAutp=Off: the camera has no such feature; did you mean 'GainAuto'?");
}

TEST_F(CameraRequests, WaitsForItsSignalWhenTriggeredByHardware) {
  request_.trigger = CameraTrigger::Hardware;
  const auto camera = open();
  EXPECT_FALSE(camera->facts().period);
  EXPECT_FALSE(camera->wait(150ms));
}

}  // namespace
}  // namespace alidade
