// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "capture/decoding.h"
#include "capture/file_sources.h"
#include "capture/recording/recording_group.h"
#include "tests/capture/recording/synthetic_camera.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

class RecordedSource : public testing::Test {
 protected:
  void record(const char* name, bool closed) {
    RecordingWriter writer(folder_ / name, camera_);
    for (int i = 0; i < 3; ++i) {
      Frame frame = test::synthetic_frame(camera_, i);
      frame.stamp.is_damaged = i == 1;
      writer.write(frame);
    }
    if (closed) writer.close();
  }
  test::TemporaryDirectory folder_;
  RecordingSubject camera_ = test::synthetic_camera({PixelKind::Bayer, 12}, {64, 48});
};

TEST_F(RecordedSource, IsOpenedByItsFolderAndDecoded) {
  record("camera", false);
  const auto source = open_files(folder_ / "camera");
  EXPECT_TRUE(source->has_times());
  EXPECT_EQ(source->describe(), "recording " + (folder_ / "camera").string() + " (synthetic:0, 64x48 px, BayerRG12)");
  const auto first = source->next(), last = source->next();
  ASSERT_TRUE(last);
  EXPECT_FALSE(source->next());
  const Frame given = test::synthetic_frame(camera_, 0);
  EXPECT_EQ(cv::norm(first->image, decode(given.image, given.format), cv::NORM_INF), 0);
  EXPECT_EQ(first->name, "camera#0");
  EXPECT_EQ(first->time, given.time);
  EXPECT_EQ(last->name, "camera#2");
  EXPECT_EQ(source->fault(),
            (folder_ / "camera").string() + ": was not closed (see 'alidade repair'); 1 damaged frame left out");
}

TEST_F(RecordedSource, OfSeveralCamerasMustBeNamed) {
  record("a", true);
  record("b", true);
  const std::vector<std::string> members{"a", "b"};
  write_recording_group(folder_.path(), "alidade test", members);
  EXPECT_NE(test::message_of(folder_.path(), [&] { open_files(folder_.path()); })
                .find("holds the recordings of 2 cameras; name one of them: a"),
            std::string::npos);
  EXPECT_EQ(open_files(folder_ / "b")->frame_count(), 3);
}

}  // namespace
}  // namespace alidade
