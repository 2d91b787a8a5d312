// SPDX-License-Identifier: Apache-2.0
#include "datasets/sky_video_files.h"

#include <gtest/gtest.h>

#include "datasets/sky_scene.h"
#include "io/table.h"
#include "io/video_reader.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

TEST(SkyVideoFiles, HoldTheFramesByteForByteAndTheirTruth) {
  SkySceneOptions options;
  options.receivers = 2;
  options.width = 160;
  options.height = 96;
  options.focal_px = 110.0;
  options.least_speed_px_s = 1.0;
  options.duration_s = 0.2;
  const SkyScene scene = make_sky_scene(options);
  const test::TemporaryDirectory directory;
  const std::vector<std::string> names = write_sky_videos(scene, directory.path());
  ASSERT_EQ(names, (std::vector<std::string>{"camera1.mkv", "camera2.mkv"}));
  std::size_t rows = 0;
  for (std::size_t k = 0; k < names.size(); ++k) {
    VideoReader reader(directory.path() / names[k]);
    SkyVideo video(scene, k);
    while (const auto frame = video.next()) {
      rows += frame->sightings.size();
      const auto read = reader.next();
      ASSERT_TRUE(read);
      ASSERT_EQ(read->image.type(), CV_8UC1);
      EXPECT_EQ(cv::norm(read->image, frame->image, cv::NORM_INF), 0.0);
      ASSERT_TRUE(read->time);
      EXPECT_NEAR(to_seconds(*read->time - frame->time), 0.0, 1e-3);  // the container counts milliseconds
    }
    EXPECT_FALSE(reader.next());
  }
  EXPECT_EQ(read_table(directory.path() / "truth_pixels.csv").row_count(), rows);
}

}  // namespace
}  // namespace alidade
