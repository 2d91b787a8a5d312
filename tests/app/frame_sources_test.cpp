// SPDX-License-Identifier: Apache-2.0
#include "app/frame_sources.h"

#include <gtest/gtest.h>

#include "core/errors.h"

namespace alidade {
namespace {

TEST(FrameSources, TellCamerasFromFiles) {
  EXPECT_TRUE(is_camera_name("v4l2:/dev/video0"));
  EXPECT_TRUE(is_camera_name("genicam:192.168.0.7"));
  EXPECT_TRUE(is_camera_name("/dev/video0"));
  EXPECT_FALSE(is_camera_name("shots/*.png"));
}

TEST(FrameSources, RefuseTheNameOfNoCamera) {
  EXPECT_THROW(camera_opener("firewire:0", {}), InputError);
}

TEST(FrameSources, ThrowWhatTheCameraSaysWhenItIsNotThere) {
  EXPECT_THROW(open_frames("v4l2:/dev/no-such-camera", {}, {}), CameraError);
}

}  // namespace
}  // namespace alidade
