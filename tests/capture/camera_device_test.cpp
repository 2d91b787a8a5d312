// SPDX-License-Identifier: Apache-2.0
#include "capture/camera_device.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

using std::chrono::milliseconds;

TEST(CameraFacts, SayHowFarAStampIsFromTheMiddleOfTheExposure) {
  CameraFacts facts;
  facts.stamped = StampedMoment::ExposureStart;
  EXPECT_EQ(stamp_to_middle(facts), milliseconds(0));
  facts.exposure = milliseconds(10);
  EXPECT_EQ(stamp_to_middle(facts), milliseconds(5));
  facts.stamped = StampedMoment::ReadoutEnd;
  EXPECT_EQ(stamp_to_middle(facts), milliseconds(-5));
  facts.stamped = StampedMoment::Unknown;
  EXPECT_EQ(stamp_to_middle(facts), milliseconds(0));
}

}  // namespace
}  // namespace alidade
