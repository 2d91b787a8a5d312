// SPDX-License-Identifier: Apache-2.0
#include "capture/file_sources.h"

#include <gtest/gtest.h>

#include "io/image_files.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"
#include "tests/support/video_clip.h"

namespace alidade {
namespace {

class FileSources : public testing::Test {
 protected:
  // An image whose pixels all have the value `grey`.
  void add_image(const std::string& name, int grey, cv::Size size = {32, 24}) {
    write_image(folder_ / name, cv::Mat(size, CV_8UC1, cv::Scalar(grey)));
  }
  struct Seen {
    std::vector<int> greys;
    std::vector<double> times_s;
    std::vector<std::string> names;
  };
  static Seen look(FrameSource& source) {
    Seen seen;
    while (const auto frame = source.next()) {
      EXPECT_EQ(frame->index, static_cast<int>(seen.greys.size()));
      seen.greys.push_back(frame->image.at<unsigned char>(0, 0));
      seen.times_s.push_back(to_seconds(frame->time.time_since_epoch()));
      seen.names.push_back(frame->name);
    }
    return seen;
  }
  std::string message(const std::string& name, std::optional<double> fps_hz = std::nullopt) {
    return test::message_of(folder_.path(), [&] {
      const auto source = open_files(folder_ / name, fps_hz);
      while (source->next()) continue;
    });
  }
  test::TemporaryDirectory folder_;
};

TEST_F(FileSources, GiveAFolderInNaturalOrderOneSecondEach) {
  for (const int i : {10, 2, 1}) add_image("frame" + std::to_string(i) + ".png", i);
  const auto source = open_files(folder_.path());
  EXPECT_EQ(source->frame_count(), 3);
  EXPECT_FALSE(source->has_times());
  const Seen seen = look(*source);
  EXPECT_EQ(seen.greys, (std::vector<int>{1, 2, 10}));
  EXPECT_EQ(seen.times_s, (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(seen.names.front(), "frame1.png");
}

TEST_F(FileSources, TakeTheFrameRateOfTheUser) {
  for (const int i : {1, 2, 3}) add_image(std::to_string(i) + ".png", i);
  const auto source = open_files(folder_ / "*.png", 4.0);
  EXPECT_TRUE(source->has_times());
  EXPECT_EQ(look(*source).times_s, (std::vector<double>{0, 0.25, 0.5}));
  EXPECT_THROW(open_files(folder_.path(), 0.0), std::invalid_argument);
}

TEST_F(FileSources, TakeTimesFromNamesBeforeTheFrameRate) {
  add_image("100.250000.png", 1);
  add_image("100.500000.png", 2);
  const auto source = open_files(folder_.path(), 30.0);
  EXPECT_TRUE(source->has_times());
  EXPECT_EQ(look(*source).times_s, (std::vector<double>{100.25, 100.5}));
}

TEST_F(FileSources, TakeTimesAndOrderFromATableBeside) {
  for (const int i : {1, 2, 3}) add_image(std::to_string(i) + ".png", i);
  folder_.write("frames.csv", "index,t_ns,image\n0,500000000,3.png\n1,1500000000,1.png\n");
  const auto source = open_files(folder_.path());
  const Seen seen = look(*source);
  EXPECT_EQ(seen.greys, (std::vector<int>{3, 1}));
  EXPECT_EQ(seen.times_s, (std::vector<double>{0.5, 1.5}));
  folder_.write("frames.csv", "index,t_ns,image\n0,5,3.png\n1,5,1.png\n");
  EXPECT_EQ(message(""), "frames.csv:3: t_ns does not increase");
  folder_.write("frames.csv", "index,t_ns,image\n0,5,4.png\n");
  EXPECT_EQ(message(""), "frames.csv:2: there is no image '4.png'");
}

TEST_F(FileSources, ReadListsWithAndWithoutTimes) {
  for (const int i : {1, 2}) add_image(std::to_string(i) + ".png", i);
  folder_.write("list.txt", "# timestamp filename\n7.5 2.png\n8.5 1.png\n");
  const auto timed = open_files(folder_ / "list.txt");
  const Seen seen = look(*timed);
  EXPECT_EQ(seen.greys, (std::vector<int>{2, 1}));
  EXPECT_EQ(seen.times_s, (std::vector<double>{7.5, 8.5}));
  folder_.write("list.txt", "2.png\n1.png\n");
  EXPECT_EQ(look(*open_files(folder_ / "list.txt")).greys, (std::vector<int>{2, 1}));
  folder_.write("list.txt", "2.png\n3.png\n");
  EXPECT_EQ(message("list.txt"), "list.txt:2: there is no image '3.png'");
  folder_.write("list.txt", "1 2.png\n1 1.png\n");
  EXPECT_EQ(message("list.txt"), "list.txt:2: time does not increase");
}

TEST_F(FileSources, GiveAVideoWithTheTimesOfItsStream) {
  test::write_clip(folder_ / "a.mp4", 12, {VideoKind::Movie, 20.0, 20});
  const auto source = open_files(folder_ / "a.mp4", 50.0);
  EXPECT_TRUE(source->has_times());
  EXPECT_EQ(source->frame_count(), 12);
  const Seen seen = look(*source);
  ASSERT_EQ(seen.times_s.size(), 12u);
  EXPECT_DOUBLE_EQ(seen.times_s[11], 0.55);
  EXPECT_EQ(seen.names[3], "a.mp4#3");
  EXPECT_FALSE(source->fault());
}

TEST_F(FileSources, SayThatAVideoIsCutOff) {
  test::write_clip(folder_ / "a.mp4", 40, {VideoKind::Movie, 20.0, 10});
  std::filesystem::resize_file(folder_ / "a.mp4", std::filesystem::file_size(folder_ / "a.mp4") / 2);
  const auto source = open_files(folder_ / "a.mp4");
  EXPECT_FALSE(source->fault()) << "not before the end";
  EXPECT_GT(look(*source).greys.size(), 10u);
  EXPECT_TRUE(source->fault());
}

TEST_F(FileSources, NameWhatIsNotThere) {
  EXPECT_EQ(message("none"), "none: there is no such file or folder; check the name");
  EXPECT_EQ(message("*.jpg"), "*.jpg: matches no image; check the name");
  std::filesystem::create_directory(folder_ / "empty");
  EXPECT_EQ(message("empty"), "empty: holds no images; name a folder with .jpg or .png files");
}

TEST_F(FileSources, AreVideosWhereTheyAreNoImagesListsOrFolders) {
  add_image("1.png", 1);
  for (const char* name : {"a.mp4", "b.csv", "c.txt"}) folder_.write(name, "");
  EXPECT_TRUE(is_video_name(folder_ / "a.mp4"));
  for (const char* name : {"1.png", "b.csv", "c.txt", "none.mp4", "."}) EXPECT_FALSE(is_video_name(folder_ / name));
}

TEST_F(FileSources, NameTheImageOfAnotherSize) {
  add_image("1.png", 1);
  add_image("2.png", 2, {16, 12});
  EXPECT_EQ(message(""), "2.png: is 16x12 px, but '1.png' is 32x24 px; all images must come from one camera");
}

TEST_F(FileSources, GiveTheFramesBeforeADamagedOne) {
  add_image("1.png", 1);
  folder_.write("2.png", "no image");
  const auto source = open_files(folder_.path());
  EXPECT_TRUE(source->next());
  EXPECT_EQ(test::message_of(folder_.path(), [&] { source->next(); }),
            "2.png: is no readable image; PNG, JPEG, BMP, PNM, TIFF or WebP is wanted");
}

}  // namespace
}  // namespace alidade
