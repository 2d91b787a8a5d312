// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_camera.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "capture/v4l2/v4l2_device.h"
#include "capture/v4l2/v4l2_listing.h"
#include "tests/support/temporary_directory.h"

// What needs a camera is tested in a virtual machine that has one: tests/faults/v4l2.
namespace alidade {
namespace {

struct Complaint {
  CameraTrouble trouble;
  std::string text;
};

Complaint complaint(const std::string& path) {
  try {
    open_v4l2(path, {});
  } catch (const CameraError& error) {
    return {error.trouble(), error.what()};
  }
  ADD_FAILURE() << path << " opened";
  return {};
}

/// This thread without the rights of root.
class Unprivileged {
 public:
  Unprivileged() : user_(geteuid()) {
    if (user_ == 0 && seteuid(65534) != 0) ADD_FAILURE() << "seteuid";
  }
  ~Unprivileged() {
    if (user_ == 0 && seteuid(0) != 0) ADD_FAILURE() << "seteuid";
  }
  Unprivileged(const Unprivileged&) = delete;
  Unprivileged& operator=(const Unprivileged&) = delete;

 private:
  uid_t user_;
};

TEST(V4l2Camera, IsGoneWhereThereIsNoSuchDevice) {
  const Complaint said = complaint("/dev/video9999");
  EXPECT_EQ(said.trouble, CameraTrouble::Gone);
  EXPECT_EQ(said.text, "/dev/video9999: open: no such device; 'alidade devices' lists the cameras");
}

TEST(V4l2Camera, RefusesWhatIsNoCamera) {
  const test::TemporaryDirectory directory;
  for (const std::string& path : {std::string("/dev/null"), directory.write("film.mp4", "x").string()}) {
    const Complaint said = complaint(path);
    EXPECT_EQ(said.trouble, CameraTrouble::Refused);
    EXPECT_EQ(said.text, path + ": open: this is no camera; 'alidade devices' lists the cameras");
  }
  EXPECT_EQ(complaint(directory.path()).trouble, CameraTrouble::Refused);
}

TEST(V4l2Camera, IsDeniedWithoutPermission) {
  const test::TemporaryDirectory directory;
  const std::filesystem::path path = directory.write("video0", "");
  std::filesystem::permissions(path, std::filesystem::perms::none);
  std::filesystem::permissions(directory.path(), std::filesystem::perms::all);
  const Unprivileged we;
  const Complaint said = complaint(path);
  EXPECT_EQ(said.trouble, CameraTrouble::Denied);
  EXPECT_NE(said.text.find("Permission denied; become a member of the group 'video'"), std::string::npos) << said.text;
  const auto listed = list_v4l2(directory.path());
  ASSERT_EQ(listed.size(), 1U);
  EXPECT_EQ(listed[0].source, "v4l2:" + path.string());
  EXPECT_NE(listed[0].trouble.find("Permission denied"), std::string::npos);
}

TEST(V4l2Camera, IsNotListedWhereItIsNone) {
  const test::TemporaryDirectory directory;
  directory.write("video0", "no device");
  directory.write("videofile", "");
  EXPECT_TRUE(list_v4l2(directory.path()).empty());
  EXPECT_TRUE(list_v4l2("/no/such/folder").empty());
}

TEST(V4l2Camera, LeaksNoDescriptorWhenItFails) {
  const auto open_descriptors = [] { return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}); };
  const auto before = open_descriptors();
  for (int i = 0; i < 20; ++i) complaint("/dev/null");
  EXPECT_EQ(open_descriptors(), before);
}

TEST(V4l2Camera, TellsTroublesApart) {
  EXPECT_EQ(v4l2_error("c", "open", EBUSY).trouble(), CameraTrouble::Busy);
  EXPECT_EQ(v4l2_error("c", "open", ENODEV).trouble(), CameraTrouble::Gone);
  EXPECT_EQ(v4l2_error("c", "open", EACCES).trouble(), CameraTrouble::Denied);
  EXPECT_EQ(v4l2_error("c", "start", ENOSPC).trouble(), CameraTrouble::Refused);
  EXPECT_STREQ(v4l2_error("c", "start", ENOSPC).what(),
               "c: start: not enough room on its bus; use another USB port, a smaller size, a lower rate or MJPG");
}

}  // namespace
}  // namespace alidade
