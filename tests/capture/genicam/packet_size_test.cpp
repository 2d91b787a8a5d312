// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/packet_size.h"

#include <arv.h>
#include <gtest/gtest.h>

#include "capture/genicam/camera_opening.h"
#include "fake_camera_process.h"

namespace alidade {
namespace {

class PacketSize : public testing::Test {
 protected:
  void SetUp() override {
    if (!process_.is_running()) GTEST_SKIP() << "no camera on loopback";
    opened_ = open_camera(FakeCameraProcess::address(), "genicam:x");
  }

  void choose(std::optional<int> wanted, const std::string& address) {
    choose_packet_size(opened_.camera.get(), address, wanted, "genicam:x");
  }

  unsigned size() const { return arv_camera_gv_get_packet_size(opened_.camera.get(), nullptr); }

  FakeCameraProcess process_;
  OpenedCamera opened_;
};

TEST_F(PacketSize, IsTheOneAskedFor) {
  choose(1400, opened_.address);
  EXPECT_EQ(size(), 1400u);
}

TEST_F(PacketSize, IsTheLargestOnLoopback) {
  choose({}, opened_.address);
  EXPECT_EQ(size(), 16404u);
}

TEST_F(PacketSize, StaysWhereTheCameraCannotTestAnother) {
  choose(1400, opened_.address);
  choose({}, "192.168.1.20");
  EXPECT_EQ(size(), 1400u);
}

TEST_F(PacketSize, IsRefusedBeyondItsBounds) {
  try {
    choose(100'000, opened_.address);
    FAIL();
  } catch (const CameraError& error) {
    EXPECT_STREQ(error.what(), "genicam:x: set the packet size: 100000 bytes are out of range; it takes 220 to 16404");
  }
}

}  // namespace
}  // namespace alidade
