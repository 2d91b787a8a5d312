// SPDX-License-Identifier: Apache-2.0
#include "app/targets/video_sky.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "core/errors.h"
#include "datasets/sky_scene.h"
#include "datasets/sky_video_files.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

// Two cameras with one dot in a small piece of sky.
SkyScene small_scene(double duration_s) {
  SkySceneOptions options;
  options.receivers = 2;
  options.width = 320;
  options.height = 180;
  options.focal_px = 225.0;
  options.least_speed_px_s = 6.0;
  options.dots = {{4.0, 12.0, true}};
  options.fps_hz = 20.0;
  options.duration_s = duration_s;
  return make_sky_scene(options);
}

struct Films {
  test::TemporaryDirectory folder;
  SkyScene scene;
  std::vector<std::string> sources;

  explicit Films(double duration_s) : scene(small_scene(duration_s)) {
    for (const std::string& name : write_sky_videos(scene, folder.path())) sources.push_back((folder / name).string());
  }

  std::string refusal(const std::vector<std::string>& videos, const std::vector<Receiver>& receivers) const {
    return test::message_of(folder.path(), [&] { open_videos(videos, receivers, {}, {}); });
  }
};

TEST(VideoSky, FindsWhatMovesInEveryCameraInOrderOfTheCommonClock) {
  const Films films(3.0);
  std::vector<ReceiverReading> readings;
  const auto sky =
      open_videos(films.sources, films.scene.receivers, [&](const ReceiverReading& r) { readings.push_back(r); }, {});
  std::vector<Bearing> bearings;
  while (const auto bearing = sky->next()) bearings.push_back(*bearing);
  EXPECT_EQ(bearings.size(), readings.size());
  ASSERT_TRUE(sky->frame_interval_s());
  EXPECT_NEAR(*sky->frame_interval_s(), 1.0 / (20.0 / 1.01), 2e-3);
  EXPECT_EQ(sky->progress().done, 60 + 60);
  EXPECT_TRUE(sky->losses().empty());
  std::vector<int> near(2, 0);
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    const Bearing& b = bearings[i];
    // A frame's bearings are of its rows' times, the frames in order.
    EXPECT_GT(b.time, bearings[i > 0 ? i - 1 : 0].time - from_seconds(0.02));
    const Eigen::Vector3d p = position_at(films.scene.paths[0], b.time) - b.origin_world;
    if (b.direction_world.cross(p).norm() / p.norm() < 2.0 / 225.0) ++near[static_cast<std::size_t>(b.receiver)];
  }
  for (const int count : near) EXPECT_GE(count, 22);  // of 30: the first 30 frames show what stands still
}

TEST(VideoSky, RefusesVideosThatDoNotFitTheReceivers) {
  const Films films(0.2);
  std::vector<Receiver> receivers = films.scene.receivers;
  EXPECT_EQ(films.refusal({films.sources[0]}, receivers),
            "camera1.mkv: 1 video for 2 receivers; give one for each receiver, in the order of their file");
  receivers[1].camera->width = 1280;
  receivers[1].camera->height = 720;
  EXPECT_EQ(films.refusal(films.sources, receivers),
            "camera2.mkv: images are 320x180 px, those of receiver 'camera2' 1280x720; give the videos in the order of "
            "the receivers, unscaled");
  receivers[1].camera.reset();
  EXPECT_EQ(films.refusal(films.sources, receivers),
            "camera2.mkv: receiver 'camera2' is a direction finder; videos go with cameras; give the others' bearings "
            "as a table");
  EXPECT_NE(films.refusal({films.sources[0], (films.folder / "nowhere.mkv").string()}, films.scene.receivers)
                .find("nowhere.mkv"),
            std::string::npos);
}

TEST(VideoSky, TellsOfAVideoThatIsCutOff) {
  const Films films(2.0);
  std::filesystem::resize_file(films.sources[1], std::filesystem::file_size(films.sources[1]) / 2);
  const auto sky = open_videos(films.sources, films.scene.receivers, {}, {});
  while (sky->next()) {
  }
  ASSERT_EQ(sky->losses().size(), 1u);
  EXPECT_NE(sky->losses()[0].find("camera2.mkv"), std::string::npos) << sky->losses()[0];
}

TEST(VideoSky, EndsWhereAStopIsRequested) {
  const Films films(0.5);
  std::stop_source stop;
  const auto sky = open_videos(films.sources, films.scene.receivers, {}, stop.get_token());
  stop.request_stop();
  while (sky->next()) {
  }
  EXPECT_LT(sky->progress().done, 20);
}

TEST(VideoSky, FindsTheVideosInAFolderByTheReceiversNames) {
  const test::TemporaryDirectory folder;
  std::vector<Receiver> receivers(2);
  receivers[0].name = "north";
  receivers[1].name = "south";
  folder.write("north.mkv", "");
  EXPECT_TRUE(videos_in(folder.path().string(), receivers).empty());  // one is missing
  folder.write("south.mp4", "");
  EXPECT_EQ(videos_in(folder.path().string(), receivers),
            (std::vector<std::string>{(folder / "north.mkv").string(), (folder / "south.mp4").string()}));
  EXPECT_TRUE(videos_in((folder / "north.mkv").string(), receivers).empty());
  folder.write("observations.csv", "");
  EXPECT_TRUE(videos_in(folder.path().string(), receivers).empty());
}

TEST(VideoSky, IsToldFromTablesByName) {
  const test::TemporaryDirectory folder;
  EXPECT_FALSE(shows_images("-"));
  EXPECT_FALSE(shows_images("a/observations.csv"));
  EXPECT_TRUE(shows_images("a/cam0.mp4"));
  EXPECT_TRUE(shows_images("genicam:192.168.0.7"));
  EXPECT_TRUE(shows_images(folder.path().string()));  // images
  folder.write("receivers.yaml", "receivers:\n");
  EXPECT_FALSE(shows_images(folder.path().string()));
}

}  // namespace
}  // namespace alidade
