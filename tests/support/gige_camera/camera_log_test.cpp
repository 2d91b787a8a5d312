// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/camera_log.h"

#include <gtest/gtest.h>

#include "tests/support/gige_camera/device_clock.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade::test {
namespace {

TEST(CameraLog, GivesBackWhatWasWritten) {
  const TemporaryDirectory directory;
  const LoggedFrame frame{
      2, 70000, 4465, 17, 1ULL << 60U, HostTime(std::chrono::nanoseconds(5)), std::chrono::microseconds(3), true};
  CameraLog(directory.path() / "log.csv").add(frame);
  EXPECT_EQ(read_camera_log(directory.path() / "log.csv"), std::vector{frame});
}

TEST(CameraLog, LeavesOutALineThatAKillCutOff) {
  const TemporaryDirectory directory;
  CameraLog(directory.path() / "log.csv").add({});
  std::ofstream(directory.path() / "log.csv", std::ios::app) << "1,1,2,1,33,33,3000,";
  EXPECT_EQ(read_camera_log(directory.path() / "log.csv").size(), 1U);
}

TEST(CameraLog, RefusesAnotherFile) {
  const TemporaryDirectory directory;
  EXPECT_EQ(message_of(directory.path(), [&] { read_camera_log(directory.path() / "none.csv"); }),
            "none.csv:1: is no log of a test camera; give what --log wrote");
}

TEST(DeviceClock, RunsFastFromItsOffset) {
  const DeviceClock clock{.offset = std::chrono::seconds(5), .rate_error_ppm = 20};
  EXPECT_EQ(clock.ticks(HostTime{}), 5'000'000'000U);
  EXPECT_EQ(clock.ticks(HostTime(std::chrono::seconds(100))), 105'002'000'000U);
}

}  // namespace
}  // namespace alidade::test
