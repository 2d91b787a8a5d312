// SPDX-License-Identifier: Apache-2.0
#include "app/camera_recording.h"

#include <gtest/gtest.h>

#include "core/errors.h"

namespace alidade {
namespace {

TEST(NamedCameras, KeepTheirNamesOrAreNumbered) {
  const auto cameras = parse_named_cameras({"left=genicam:A", "v4l2:/dev/video0", "/dev/v4l/by-id/a=b"});
  ASSERT_EQ(cameras.size(), 3u);
  EXPECT_EQ(cameras[0].name, "left");
  EXPECT_EQ(cameras[0].source, "genicam:A");
  EXPECT_EQ(cameras[1].name, "camera_1");
  EXPECT_EQ(cameras[2].source, "/dev/v4l/by-id/a=b");
}

TEST(NamedCameras, NeedNoNameWhereThereIsOne) {
  EXPECT_EQ(parse_named_cameras({"v4l2:/dev/video0"}).front().name, "");
}

TEST(NamedCameras, AreRefusedWhereTwoAreOneOrANameIsNoFolders) {
  EXPECT_THROW(parse_named_cameras({"a=genicam:1", "a=genicam:2"}), InputError);
  EXPECT_THROW(parse_named_cameras({"a=genicam:1", "b=genicam:1"}), InputError);
  EXPECT_THROW(parse_named_cameras({"..=genicam:1"}), InputError);
  EXPECT_THROW(parse_named_cameras({"a b=genicam:1"}), InputError);
}

}  // namespace
}  // namespace alidade
