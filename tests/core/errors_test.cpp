// SPDX-License-Identifier: Apache-2.0
#include "core/errors.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(InputError, IsOneLineWithPlaceFaultAndRemedy) {
  const InputError error("rig.yaml", 12, "fx must be > 0 px, got -3.1", "re-run 'alidade calibrate'");
  EXPECT_STREQ(error.what(), "rig.yaml:12: fx must be > 0 px, got -3.1; re-run 'alidade calibrate'");
  EXPECT_EQ(error.path(), "rig.yaml");
  EXPECT_EQ(error.line(), 12);
  EXPECT_EQ(error.remedy(), "re-run 'alidade calibrate'");
}

TEST(InputError, LeavesOutTheLineAndTheRemedyWhereThereIsNone) {
  EXPECT_STREQ(InputError("images", 0, "is empty", "").what(), "images: is empty");
}

TEST(DeviceError, IsOneLineWithDeviceOperationReasonAndRemedy) {
  const DeviceError error("/dev/video0", "start", "Device or resource busy", "close the other program");
  EXPECT_STREQ(error.what(), "/dev/video0: start: Device or resource busy; close the other program");
  EXPECT_EQ(error.device(), "/dev/video0");
}

}  // namespace
}  // namespace alidade
