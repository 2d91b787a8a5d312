// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_names.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

TEST(V4l2Names, AreThoseOfTheCameraThenOfItsSocket) {
  const test::TemporaryDirectory directory;
  const fs::path node = directory.write("video0", "");
  const fs::path other = directory.write("video1", "");
  fs::create_directories(directory / "by-id");
  fs::create_directories(directory / "by-path");
  fs::create_symlink(node, directory / "by-path" / "pci-0");
  fs::create_symlink("../video0", directory / "by-id" / "usb-camera-index0");
  fs::create_symlink("../video1", directory / "by-id" / "usb-camera-index1");
  fs::create_symlink("../video2", directory / "by-id" / "usb-unplugged");
  EXPECT_EQ(lasting_names(node, directory.path()),
            (std::vector<fs::path>{directory / "by-id" / "usb-camera-index0", directory / "by-path" / "pci-0"}));
  EXPECT_EQ(lasting_names(other, directory.path()).size(), 1U);
}

TEST(V4l2Names, AreNoneWhereTheSystemGivesNone) {
  EXPECT_TRUE(lasting_names("/dev/null", "/no/such/folder").empty());
}

TEST(V4l2Names, KnowTheSerialNumberOfTheUsbDevice) {
  const test::TemporaryDirectory directory;
  const fs::path node = directory.write("video7", "");
  fs::create_directories(directory / "devices/usb1/1-1:1.0");
  directory.write("devices/usb1/serial", "A12B\n");
  fs::create_directories(directory / "class/video4linux/video7");
  fs::create_symlink(directory / "devices/usb1/1-1:1.0", directory / "class/video4linux/video7/device");
  EXPECT_EQ(usb_serial(node, directory.path()), "A12B");
  EXPECT_EQ(usb_serial(directory.write("video8", ""), directory.path()), "");
}

}  // namespace
}  // namespace alidade
