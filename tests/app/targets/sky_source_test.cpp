// SPDX-License-Identifier: Apache-2.0
#include "app/targets/sky_source.h"

#include <algorithm>
#include <filesystem>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/errors.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

constexpr const char* kFinders =
    "receivers:\n"
    "  - {id: 0, name: hill, model: direction_finder, sigma_rad: 0.001, clock: common,\n"
    "     T_world_receiver: {translation_m: [0, 0, 0], quaternion_wxyz: [1, 0, 0, 0]}}\n"
    "  - {id: 4, name: roof, model: direction_finder, sigma_rad: 0.001, clock: {offset_s: 0.25},\n"
    "     T_world_receiver: {translation_m: [50, 0, 0], quaternion_wxyz: [1, 0, 0, 0]}}\n";

constexpr const char* kHead = "t_s,receiver,azimuth_rad,elevation_rad\n";

// While it lives, standard input is a file.
class StandardInput {
 public:
  explicit StandardInput(const std::filesystem::path& path) : before_(::dup(STDIN_FILENO)) {
    const int file = ::open(path.c_str(), O_RDONLY);
    ::dup2(file, STDIN_FILENO);
    ::close(file);
  }
  ~StandardInput() {
    ::dup2(before_, STDIN_FILENO);
    ::close(before_);
  }
  StandardInput(const StandardInput&) = delete;
  StandardInput& operator=(const StandardInput&) = delete;

 private:
  int before_;
};

std::vector<Receiver> cameras(int count) {
  std::vector<Receiver> receivers(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    Receiver& receiver = receivers[static_cast<std::size_t>(i)];
    receiver.id = i;
    receiver.camera = Camera{640, 480, 500, 500, 320, 240, {}, 0};
  }
  return receivers;
}

std::vector<double> times_of(SkySource& sky) {
  std::vector<double> times;
  while (const auto bearing = sky.next()) times.push_back(to_seconds(bearing->time.time_since_epoch()));
  return times;
}

TEST(SkySource, GivesAFilesBearingsInOrderOfTheCommonClock) {
  const test::TemporaryDirectory folder;
  const auto receivers = read_receivers_of(folder.write("receivers.yaml", kFinders).string());
  const auto file = folder.write("o.csv", std::string(kHead) + "0.5,0,0,0\n0.2,4,0,0\n0.3,4,0,0\n0.4,0,0,0\n");
  const auto sky = open_sky(file.string(), receivers, {});
  EXPECT_EQ(sky->progress().total, 4);
  EXPECT_EQ(times_of(*sky), (std::vector<double>{0.4, 0.45, 0.5, 0.55}));
  EXPECT_EQ(sky->progress().done, 4);
  EXPECT_FALSE(sky->frame_interval_s());
  EXPECT_EQ(sky->without_direction(), 0);
}

TEST(SkySource, TakesAFolderOfReceiversAndObservations) {
  const test::TemporaryDirectory folder;
  folder.write("receivers.yaml", kFinders);
  folder.write("observations.csv", std::string(kHead) + "0.5,0,0,0\n");
  const auto receivers = read_receivers_of(folder.path().string());
  ASSERT_EQ(receivers.size(), 2u);
  EXPECT_EQ(receivers[1].id, 4);
  EXPECT_EQ(times_of(*open_sky(folder.path().string(), receivers, {})), (std::vector<double>{0.5}));
}

TEST(SkySource, GivesWhatLiesBeforeADamagedLineAndThenNamesIt) {
  const test::TemporaryDirectory folder;
  const auto receivers = read_receivers_of(folder.write("receivers.yaml", kFinders).string());
  const auto file = folder.write("o.csv", std::string(kHead) + "0.5,0,0,0\n0.6,0,0,nan\n0.7,0,0,0\n");
  const auto sky = open_sky(file.string(), receivers, {});
  EXPECT_TRUE(sky->next());
  EXPECT_EQ(test::message_of(folder.path(), [&] { sky->next(); }),
            "o.csv:3: column 'elevation_rad': 'nan' is not a finite number; correct it or leave the row out");
}

TEST(SkySource, RefusesAFileThatIsNotThereAtOnce) {
  const test::TemporaryDirectory folder;
  EXPECT_THROW(open_sky((folder / "o.csv").string(), cameras(2), {}), InputError);
  EXPECT_THROW(open_sky(folder.path().string(), cameras(2), {}), InputError);
  EXPECT_THROW(read_receivers_of(folder.path().string()), InputError);
}

// Camera 0 with 10, camera 1 with 8 frames a second, of which one is lost; two objects in each frame.
TEST(SkySource, KnowsHowFastTheSlowestCamerasFramesCome) {
  const test::TemporaryDirectory folder;
  std::string text = "t_ns,receiver,u_px,v_px\n";
  for (int frame = 0; frame < 20; ++frame) {
    for (const int u : {100, 200}) {
      text += std::to_string(frame * 100'000'000LL) + ",0," + std::to_string(u) + ",50\n";
      if (frame != 7) text += std::to_string(frame * 125'000'000LL) + ",1," + std::to_string(u) + ",50\n";
    }
  }
  const auto sky = open_sky(folder.write("o.csv", text).string(), cameras(2), {});
  ASSERT_TRUE(sky->frame_interval_s());
  EXPECT_NEAR(*sky->frame_interval_s(), 0.125, 1e-9);
}

TEST(SkySource, CountsPixelsThatHaveNoDirection) {
  std::vector<Receiver> receivers = cameras(2);
  receivers[0].camera->distortion = BrownConrady{-1.0, 0.0, 0.0, 0.0, 0.0};  // folds back at 1/√3
  const test::TemporaryDirectory folder;
  const auto file = folder.write("o.csv", "t_s,receiver,u_px,v_px\n0,0,320,240\n0,0,639,479\n0,1,639,479\n");
  const auto sky = open_sky(file.string(), receivers, {});
  EXPECT_EQ(times_of(*sky).size(), 2u);
  EXPECT_EQ(sky->without_direction(), 1);
}

// Camera frames at 10 Hz on standard input: the first second of them is looked at beforehand, and none is lost.
TEST(SkySource, ListensToALiveFeedOfCamerasFirst) {
  const test::TemporaryDirectory folder;
  std::string text = "t_ns,receiver,u_px,v_px\n";
  for (int frame = 0; frame < 30; ++frame) {
    for (const int receiver : {0, 1}) {
      text += std::to_string(frame * 100'000'000LL) + "," + std::to_string(receiver) + ",100,50\n";
    }
  }
  const StandardInput feed(folder.write("o.csv", text));
  const auto sky = open_sky("-", cameras(2), {});
  ASSERT_TRUE(sky->frame_interval_s());
  EXPECT_NEAR(*sky->frame_interval_s(), 0.1, 1e-9);
  const std::vector<double> times = times_of(*sky);
  ASSERT_EQ(times.size(), 60u);
  EXPECT_TRUE(std::ranges::is_sorted(times));
}

TEST(SkySource, GivesWhatALiveFeedSaidBeforeItsDamagedLine) {
  const test::TemporaryDirectory folder;
  const StandardInput feed(folder.write("o.csv", "t_s,receiver,u_px,v_px\n0,0,5,5\n0,7,5,5\n"));
  const auto sky = open_sky("-", cameras(2), {});
  EXPECT_TRUE(sky->next());
  EXPECT_EQ(test::message_of(folder.path(), [&] { sky->next(); }),
            "standard input:3: unknown receiver 7; known are: 0, 1");
}

TEST(SkySource, EndsWhereAStopIsRequested) {
  const test::TemporaryDirectory folder;
  const auto receivers = read_receivers_of(folder.write("receivers.yaml", kFinders).string());
  std::stop_source stop;
  const auto sky =
      open_sky(folder.write("o.csv", std::string(kHead) + "0,0,0,0\n1,0,0,0\n").string(), receivers, stop.get_token());
  EXPECT_TRUE(sky->next());
  stop.request_stop();
  EXPECT_FALSE(sky->next());
}

}  // namespace
}  // namespace alidade
