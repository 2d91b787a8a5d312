// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/genicam_listing.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "capture/genicam/genicam_camera.h"
#include "fake_camera_process.h"

namespace alidade {
namespace {

TEST(GenicamListing, DescribesACameraByItsAddress) {
  const FakeCameraProcess process;
  if (!process.is_running()) GTEST_SKIP() << "no camera on loopback";
  const ListedCamera camera = describe_genicam(process.address());
  EXPECT_EQ(camera.source, "genicam:127.0.0.1");
  EXPECT_EQ(camera.model, "Aravis Fake");
  EXPECT_EQ(camera.serial, process.serial());
  EXPECT_EQ(camera.driver, "GigE Vision");
  EXPECT_EQ(camera.trouble, "");
  ASSERT_EQ(camera.formats.size(), 7u);
  EXPECT_EQ(camera.formats[4].name, "Mono8");
  EXPECT_TRUE(camera.formats[4].is_readable);
  ASSERT_EQ(camera.formats[4].sizes.size(), 1u);
  EXPECT_EQ(camera.formats[4].sizes[0].size, cv::Size(2048, 2048));
  EXPECT_EQ(camera.formats[4].sizes[0].least, cv::Size(1, 1));
  EXPECT_EQ(camera.formats[4].sizes[0].fps_hz, (std::vector<double>{1000, 0.1}));
  const auto is_width = [](const ListedControl& control) { return control.name == "Width"; };
  EXPECT_TRUE(std::any_of(camera.controls.begin(), camera.controls.end(), is_width));
}

TEST(GenicamListing, SaysThatACameraIsInUseAndStillWhoItIs) {
  const FakeCameraProcess process;
  if (!process.is_running()) GTEST_SKIP() << "no camera on loopback";
  const auto user = open_genicam(process.address(), {});
  const ListedCamera camera = describe_genicam(process.address());
  EXPECT_EQ(camera.trouble, "in use");
  EXPECT_EQ(camera.serial, process.serial());
  EXPECT_TRUE(camera.formats.empty());
}

TEST(GenicamListing, ThrowsWhereNobodyAnswers) {
  EXPECT_THROW(describe_genicam("127.0.0.79"), CameraError);
}

TEST(GenicamListing, NamesEveryCameraThatItFinds) {
  for (const ListedCamera& camera : list_genicam()) {  // often none: most machines have no such camera
    EXPECT_TRUE(camera.source.starts_with("genicam:"));
    EXPECT_GT(camera.source.size(), 8u);
  }
}

}  // namespace
}  // namespace alidade
