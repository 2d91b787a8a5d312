// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_control.h"

#include <gtest/gtest.h>

#include "capture/camera_device.h"

namespace alidade {
namespace {

V4l2Control integer() {
  V4l2Control control;
  control.name = "gain";
  control.least = -4;
  control.most = 100;
  control.step = 2;
  return control;
}

V4l2Control choice() {
  V4l2Control control;
  control.name = "auto_exposure";
  control.kind = V4l2ControlKind::Choice;
  control.most = 3;
  control.entries = {{1, "Manual Mode"}, {3, "Aperture Priority Mode"}};
  return control;
}

std::string complaint(const V4l2Control& control, const char* text) {
  try {
    parse_v4l2_value("/dev/video0", control, text);
  } catch (const CameraError& error) {
    EXPECT_EQ(error.trouble(), CameraTrouble::Refused);
    return error.what();
  }
  return "";
}

TEST(V4l2Control, IsNamedLikeOnTheUsualCommandLine) {
  EXPECT_EQ(v4l2_control_name("Exposure Time, Absolute"), "exposure_time_absolute");
  EXPECT_EQ(v4l2_control_name("White Balance, Automatic"), "white_balance_automatic");
  EXPECT_EQ(v4l2_control_name(" Integer 32 Bits (!)"), "integer_32_bits");
  EXPECT_EQ(v4l2_control_name(""), "");
}

TEST(V4l2Control, TakesIntegersOfItsRangeAndStep) {
  EXPECT_EQ(parse_v4l2_value("", integer(), "-4"), -4);
  EXPECT_EQ(parse_v4l2_value("", integer(), "0x10"), 16);
  EXPECT_EQ(complaint(integer(), "101"),
            "/dev/video0: set gain: '101' is not one of its values; it takes -4 to 100 by 2");
  for (const char* wrong : {"-6", "1", "2.0", "", "--2", "much"}) EXPECT_NE(complaint(integer(), wrong), "") << wrong;
}

TEST(V4l2Control, TakesEntriesByNumberAndByName) {
  EXPECT_EQ(parse_v4l2_value("", choice(), "1"), 1);
  EXPECT_EQ(parse_v4l2_value("", choice(), "Aperture Priority Mode"), 3);
  EXPECT_EQ(parse_v4l2_value("", choice(), "manual_mode"), 1);
  EXPECT_EQ(complaint(choice(), "2"),
            "/dev/video0: set auto_exposure: '2' is not one of its values; it takes 1 (Manual Mode), 3 (Aperture "
            "Priority Mode)");
}

TEST(V4l2Control, TakesOnAndOff) {
  V4l2Control control;
  control.kind = V4l2ControlKind::Boolean;
  control.most = 1;
  EXPECT_EQ(parse_v4l2_value("", control, "on"), 1);
  EXPECT_EQ(parse_v4l2_value("", control, "False"), 0);
  EXPECT_EQ(parse_v4l2_value("", control, "1"), 1);
  EXPECT_NE(complaint(control, "2"), "");
}

TEST(V4l2Control, IsFoundByItsNameOnly) {
  const std::vector controls{integer(), choice()};
  EXPECT_EQ(&find_v4l2_control("/dev/video0", controls, "auto_exposure"), &controls[1]);
  try {
    find_v4l2_control("/dev/video0", controls, "gian");
    FAIL();
  } catch (const CameraError& error) {
    EXPECT_STREQ(error.what(), "/dev/video0: set gian: the camera has no such control; did you mean 'gain'?");
  }
}

}  // namespace
}  // namespace alidade
