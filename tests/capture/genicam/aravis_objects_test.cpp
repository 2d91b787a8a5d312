// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/aravis_objects.h"

#include <string>

#include <arv.h>
#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(AravisFault, ChecksAsNothingWhereNothingHappened) {
  EXPECT_NO_THROW(AravisFault().check("genicam:x", "open"));
}

TEST(AravisFault, TellsSourceOperationAndReason) {
  AravisFault fault;
  g_set_error(fault.out(), ARV_DEVICE_ERROR, ARV_DEVICE_ERROR_TIMEOUT, "GigEVision read_register timeout");
  try {
    fault.check("genicam:10.0.0.1", "read its region");
    FAIL();
  } catch (const CameraError& error) {
    EXPECT_EQ(error.trouble(), CameraTrouble::Gone);
    EXPECT_STREQ(error.what(),
                 "genicam:10.0.0.1: read its region: GigEVision read_register timeout; check power, cable and address");
  }
}

TEST(AravisFault, TellsWhoIsToBlame) {
  AravisFault fault;
  g_set_error(fault.out(), ARV_DEVICE_ERROR, ARV_DEVICE_ERROR_PROTOCOL_ERROR_ACCESS_DENIED, "denied");
  EXPECT_EQ(fault.trouble(), CameraTrouble::Busy);
  g_set_error(fault.out(), ARV_DEVICE_ERROR, ARV_DEVICE_ERROR_FEATURE_NOT_FOUND, "no feature");
  EXPECT_EQ(fault.trouble(), CameraTrouble::Refused);
  g_set_error(fault.out(), ARV_GC_ERROR, ARV_GC_ERROR_OUT_OF_RANGE, "out of range");
  EXPECT_EQ(fault.trouble(), CameraTrouble::Refused);
}

TEST(SilenceAravis, KeepsItsWarningsOffStandardError) {
  silence_aravis();
  testing::internal::CaptureStderr();
  g_log("Aravis", G_LOG_LEVEL_WARNING, "something is odd");
  // Of an interface that there is not, Aravis warns in its own way.
  ArvGvFakeCamera* const camera = arv_gv_fake_camera_new("no such interface", nullptr);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  if (camera) g_object_unref(camera);
}

}  // namespace
}  // namespace alidade
