// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/camera_opening.h"

#include <chrono>

#include <arv.h>
#include <gtest/gtest.h>

#include "capture/genicam/genicam_camera.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

// Only Aravis' camera within this process can be found by its name: no second is spent on a broadcast.
class CameraOpening : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    arv_enable_interface("Fake");
    arv_disable_interface("GigEVision");
    arv_disable_interface("USB3Vision");
  }

  static CameraError refusal(const std::string& id) {
    try {
      open_camera(id, "genicam:" + id);
    } catch (const CameraError& error) {
      return error;
    }
    throw std::logic_error("opened " + id);
  }
};

TEST_F(CameraOpening, TellsAddressesFromOtherNames) {
  EXPECT_EQ(address_of("192.168.1.20"), "192.168.1.20");
  EXPECT_EQ(address_of("localhost"), "127.0.0.1");
  EXPECT_EQ(address_of("GV01"), "");
  EXPECT_EQ(address_of(""), "");
}

TEST_F(CameraOpening, NeverTakesJustAnyCamera) {
  const CameraError error = refusal("");
  EXPECT_EQ(error.trouble(), CameraTrouble::Refused);
  EXPECT_STREQ(error.what(),
               "genicam:: open: names no camera; give a network address, serial number or id: genicam:192.168.1.20");
}

TEST_F(CameraOpening, SaysThatNobodyHasThatName) {
  const CameraError error = refusal("Fake_2");
  EXPECT_EQ(error.trouble(), CameraTrouble::Gone);
  EXPECT_STREQ(error.what(),
               "genicam:Fake_2: open: no GenICam camera of that serial number or id answers; give its "
               "network address; 'alidade devices' lists the cameras");
}

TEST_F(CameraOpening, SaysWithinASecondThatNobodyIsAtThatAddress) {
  for (const char* const address : {"127.0.0.77", "192.0.2.1"}) {  // the second is reserved: no host has it
    const auto start = std::chrono::steady_clock::now();
    const CameraError error = refusal(address);
    EXPECT_LT(std::chrono::steady_clock::now() - start, 1500ms);
    EXPECT_EQ(error.trouble(), CameraTrouble::Gone);
    EXPECT_EQ(std::string(error.what()), "genicam:" + std::string(address) +
                                             ": open: no GigE Vision camera answers at " + address +
                                             "; check power, cable and address");
  }
}

TEST_F(CameraOpening, FindsACameraByItsIdThatStreams) {
  CameraRequest request;
  request.size = cv::Size(64, 48);
  request.fps_hz = 200;
  const auto camera = open_genicam("Fake_1", request);
  EXPECT_EQ(camera->facts().model, "Aravis Fake");
  EXPECT_EQ(camera->facts().size, cv::Size(64, 48));
  for (int i = 0; i < 3; ++i) {
    const auto frame = camera->wait(1s);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->image.size(), cv::Size(64, 48));
  }
}

}  // namespace
}  // namespace alidade
