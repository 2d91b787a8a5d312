// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/camera_features.h"

#include <algorithm>
#include <optional>

#include <arv.h>
#include <gtest/gtest.h>

namespace alidade {
namespace {

// Aravis' camera within this process.
class CameraFeatures : public testing::Test {
 protected:
  void set(const std::string& name, const std::string& value) { set_feature(device_.get(), name, value, "genicam:x"); }

  std::string refusal(const std::string& name, const std::string& value) {
    try {
      set(name, value);
    } catch (const CameraError& error) {
      EXPECT_EQ(error.trouble(), CameraTrouble::Refused);
      return error.what();
    }
    return "";
  }

  std::string value_of(const std::string& name) { return describe_feature(device_.get(), name).value; }

  GObjectPointer<ArvDevice> device_{arv_fake_device_new("T1", nullptr)};
};

TEST_F(CameraFeatures, AreNamedEachOnce) {
  auto names = feature_names(device_.get());
  EXPECT_NE(std::find(names.begin(), names.end(), "Width"), names.end());
  EXPECT_NE(std::find(names.begin(), names.end(), "GainAuto"), names.end());  // of a category that the root leaves out
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

TEST_F(CameraFeatures, AreThereOrNot) {
  EXPECT_TRUE(has_feature(device_.get(), "Width"));
  EXPECT_FALSE(has_feature(device_.get(), "Depth"));
}

TEST_F(CameraFeatures, OfEveryKindAreSet) {
  set("Width", "640");
  set("Height", "0x80");
  set("AcquisitionFrameRate", "12.5");
  set("GainAuto", "Continuous");
  set("TestBoolean", "true");
  set("TestStringReg", "seven");
  set("TriggerSoftware", "1");
  EXPECT_EQ(value_of("Width"), "640");
  EXPECT_EQ(value_of("Height"), "128");
  EXPECT_DOUBLE_EQ(std::stod(value_of("AcquisitionFrameRate")), 12.5);
  EXPECT_EQ(value_of("GainAuto"), "Continuous");
  EXPECT_EQ(value_of("TestBoolean"), "true");
  EXPECT_EQ(value_of("TestStringReg"), "seven");
}

TEST_F(CameraFeatures, OfAWrongNameAreRefusedWithTheNearest) {
  EXPECT_EQ(refusal("GainAuot", "Off"),
            "genicam:x: set GainAuot=Off: the camera has no such feature; did you mean 'GainAuto'?");
  EXPECT_EQ(refusal("Colour", "1"),
            "genicam:x: set Colour=1: the camera has no such feature; 'alidade devices' lists its features");
  EXPECT_NE(refusal("DeviceControl", "1"), "");  // a category is none
}

TEST_F(CameraFeatures, TellWhatTheyTake) {
  EXPECT_EQ(refusal("GainAuto", "off"),
            "genicam:x: set GainAuto=off: is none of its choices; it takes Off, Once, Continuous");
  EXPECT_EQ(refusal("Width", "0"), "genicam:x: set Width=0: is out of range; it takes 1 to 2048");
  EXPECT_EQ(refusal("Width", "wide"), "genicam:x: set Width=wide: is not a whole number; it takes 1 to 2048");
  EXPECT_EQ(refusal("AcquisitionFrameRate", "1e6"),
            "genicam:x: set AcquisitionFrameRate=1e6: is out of range; it takes 0.1 to 1000");
  EXPECT_EQ(refusal("TestBoolean", "maybe"),
            "genicam:x: set TestBoolean=maybe: is neither true nor false; give true or false");
  EXPECT_EQ(refusal("TriggerSoftware", "now"),
            "genicam:x: set TriggerSoftware=now: is a command and takes no value; write TriggerSoftware=1");
  EXPECT_EQ(refusal("SensorWidth", "100"), "genicam:x: set SensorWidth=100: it can only be read; leave it out");
}

TEST_F(CameraFeatures, AreDescribed) {
  const ListedControl width = describe_feature(device_.get(), "Width");
  EXPECT_EQ(width.kind, "integer");
  EXPECT_EQ(width.range, "1 to 2048");
  EXPECT_TRUE(width.is_writable);
  const ListedControl gain = describe_feature(device_.get(), "GainAuto");
  EXPECT_EQ(gain.kind, "choice");
  EXPECT_EQ(gain.choices, (std::vector<std::string>{"Off", "Once", "Continuous"}));
  const ListedControl model = describe_feature(device_.get(), "DeviceModelName");
  EXPECT_EQ(model.kind, "text");
  EXPECT_FALSE(model.is_writable);
  arv_gc_set_default_node_data(arv_device_get_genicam(device_.get()), "Heat",
                               "<Float Name=\"Heat\"><Value>36.5</Value><Unit>C</Unit></Float>", nullptr);
  const ListedControl heat = describe_feature(device_.get(), "Heat");
  EXPECT_EQ(heat.kind, "float");
  EXPECT_EQ(heat.unit, "C");
  EXPECT_EQ(heat.range, "");
  EXPECT_EQ(describe_feature(device_.get(), "TriggerSoftware").kind, "command");
}

}  // namespace
}  // namespace alidade
