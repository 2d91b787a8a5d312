// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/gvcp.h"

#include <gtest/gtest.h>

#include "capture/genicam/genicam_camera.h"
#include "fake_camera_process.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

TEST(Gvcp, HearsNobodyWhereNobodyIs) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(ask_gige_camera("127.0.0.78", 600ms));
  EXPECT_FALSE(may_control_gige_camera("127.0.0.78", 600ms));
  EXPECT_FALSE(ask_gige_camera("no address", 600ms));
  EXPECT_LT(std::chrono::steady_clock::now() - start, 300ms);  // the host refuses at once
}

TEST(Gvcp, HearsWhoTheCameraIs) {
  const FakeCameraProcess process;
  if (!process.is_running()) GTEST_SKIP() << "no camera on loopback";
  const auto identity = ask_gige_camera(process.address(), 600ms);
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->maker, "Aravis");
  EXPECT_EQ(identity->serial, process.serial());
  EXPECT_EQ(identity->host_address, "127.0.0.1");
}

TEST(Gvcp, GivesControlBackThatItAskedFor) {
  const FakeCameraProcess process;
  if (!process.is_running()) GTEST_SKIP() << "no camera on loopback";
  EXPECT_TRUE(may_control_gige_camera(process.address(), 600ms));
  EXPECT_TRUE(may_control_gige_camera(process.address(), 600ms));
}

TEST(Gvcp, IsDeniedControlThatAnotherHas) {
  const FakeCameraProcess process;
  if (!process.is_running()) GTEST_SKIP() << "no camera on loopback";
  const auto other = open_genicam(process.address(), {});
  EXPECT_FALSE(may_control_gige_camera(process.address(), 300ms));
  EXPECT_TRUE(ask_gige_camera(process.address(), 300ms));
  EXPECT_TRUE(other->wait(2s));
}

TEST(Gvcp, GivesUpOnACameraThatStandsStill) {
  FakeCameraProcess process;
  if (!process.is_running()) GTEST_SKIP() << "no camera on loopback";
  process.stop();
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(ask_gige_camera(process.address(), 150ms));
  EXPECT_LT(std::chrono::steady_clock::now() - start, 400ms);
}

}  // namespace
}  // namespace alidade
