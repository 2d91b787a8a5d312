// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "io/text_lines.h"
#include "io/video_reader.h"
#include "io/video_writer.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"
#include "tests/support/video_clip.h"

namespace alidade {
namespace {

constexpr VideoOptions kMovie{VideoKind::Movie, 25.0, 10};
constexpr VideoOptions kLossless{VideoKind::Lossless, 25.0, 0};
const cv::Size kSize{160, 120};

class VideoFile : public testing::Test {
 protected:
  struct Seen {
    std::vector<VideoFrame> frames;
    std::optional<std::string> fault;
  };
  Seen look(const std::string& name) {
    VideoReader reader(folder_ / name);
    Seen seen;
    while (auto frame = reader.next()) seen.frames.push_back(*frame);
    seen.fault = reader.fault();
    if (seen.fault && seen.fault->starts_with(folder_.path().string())) {
      seen.fault->erase(0, folder_.path().string().size() + 1);
    }
    return seen;
  }
  // Keeps the first `fraction` of a file.
  void cut(const std::string& name, double fraction) {
    std::filesystem::resize_file(folder_ / name,
                                 static_cast<std::uintmax_t>(fraction * std::filesystem::file_size(folder_ / name)));
  }
  test::TemporaryDirectory folder_;
};

TEST_F(VideoFile, OfAMovieComesBackCloseAndInTime) {
  test::write_clip(folder_ / "a.mp4", 30, kMovie);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.mp4.part"));
  const VideoReader reader(folder_ / "a.mp4");
  EXPECT_EQ(reader.facts().frame_count, 30);
  EXPECT_EQ(reader.facts().fps_hz, 25.0);
  EXPECT_EQ(reader.facts().width, 160);
  const Seen seen = look("a.mp4");
  ASSERT_EQ(seen.frames.size(), 30u);
  EXPECT_FALSE(seen.fault) << *seen.fault;
  for (int i = 0; i < 30; ++i) {
    const VideoFrame& frame = seen.frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(frame.time, Timestamp(std::chrono::milliseconds(40 * i)));
    const cv::Mat written = test::clip_frame(i, kSize, CV_8UC3);
    // Chroma is halved in a movie, so edges between blocks of another colour bleed; the mean colour must not.
    const cv::Scalar shift = cv::mean(written) - cv::mean(frame.image);
    EXPECT_LT(cv::norm(shift), 3.0) << "frame " << i;
    EXPECT_GT(cv::norm(test::clip_frame(i + 1, kSize, CV_8UC3), frame.image, cv::NORM_L1),
              3 * cv::norm(written, frame.image, cv::NORM_L1));
  }
}

TEST_F(VideoFile, OfNoLossComesBackExactly) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    test::write_clip(folder_ / "a.mkv", 12, kLossless, {161, 121}, type);
    const Seen seen = look("a.mkv");
    ASSERT_EQ(seen.frames.size(), 12u);
    EXPECT_FALSE(seen.fault) << *seen.fault;
    for (int i = 0; i < 12; ++i) {
      const VideoFrame& frame = seen.frames[static_cast<std::size_t>(i)];
      ASSERT_EQ(frame.image.type(), type);
      EXPECT_EQ(cv::norm(frame.image, test::clip_frame(i, {161, 121}, type), cv::NORM_INF), 0)
          << "frame " << i << " of type " << type;
      EXPECT_EQ(frame.time, Timestamp(std::chrono::milliseconds(40 * i)));
    }
  }
}

TEST_F(VideoFile, GivesTheSamePixelsEveryTime) {
  test::write_clip(folder_ / "a.mp4", 20, kMovie);
  const Seen first = look("a.mp4"), second = look("a.mp4");
  ASSERT_EQ(first.frames.size(), second.frames.size());
  for (std::size_t i = 0; i < first.frames.size(); ++i) {
    EXPECT_EQ(cv::norm(first.frames[i].image, second.frames[i].image, cv::NORM_INF), 0);
  }
}

TEST_F(VideoFile, OfTheSameFramesHasTheSameBytes) {
  for (const VideoOptions& options : {kMovie, kLossless}) {
    test::write_clip(folder_ / "first", 40, options);
    for (int i = 0; i < 10; ++i) {
      test::write_clip(folder_ / "again", 40, options);
      ASSERT_TRUE(read_bytes(folder_ / "first") == read_bytes(folder_ / "again")) << "writing " << i;
    }
  }
}

TEST_F(VideoFile, OfOddSizeIsPaddedInAMovie) {
  test::write_clip(folder_ / "a.mp4", 3, kMovie, {63, 47});
  EXPECT_EQ(look("a.mp4").frames.at(2).image.size(), cv::Size(64, 48));
}

TEST_F(VideoFile, ThatIsCutOffGivesWhatIsThereAndSaysSo) {
  for (const char* name : {"a.mp4", "a.mkv"}) {
    test::write_clip(folder_ / name, 50, std::string_view(name) == "a.mp4" ? kMovie : kLossless);
    cut(name, 0.6);
    const Seen seen = look(name);
    EXPECT_GT(seen.frames.size(), 15u) << name;
    EXPECT_LT(seen.frames.size(), 45u) << name;
    ASSERT_TRUE(seen.fault) << name;
    EXPECT_NE(seen.fault->find("s of 2.000 s, " + std::to_string(seen.frames.size()) +
                               " frames can be read; the file is cut off or damaged"),
              std::string::npos)
        << *seen.fault;
  }
}

TEST_F(VideoFile, ThatIsDamagedInTheMiddleGivesTheRestAndSaysSo) {
  test::write_clip(folder_ / "a.mkv", 50, kLossless);
  std::string bytes = read_bytes(folder_ / "a.mkv");
  for (std::size_t i = 0; i < 400; ++i) bytes[bytes.size() / 2 + i] = static_cast<char>(i * 37);
  folder_.write("a.mkv", bytes);
  const Seen seen = look("a.mkv");
  EXPECT_GE(seen.frames.size(), 40u);
  EXPECT_LT(seen.frames.size(), 50u);
  ASSERT_TRUE(seen.fault);
  EXPECT_EQ(*seen.fault, "a.mkv: " + std::to_string(50 - seen.frames.size()) + " frames are damaged or missing, " +
                             std::to_string(seen.frames.size()) + " can be read");
  for (const VideoFrame& frame : seen.frames) {
    const int index = static_cast<int>(frame.time->time_since_epoch() / std::chrono::milliseconds(40));
    EXPECT_EQ(cv::norm(frame.image, test::clip_frame(index, kSize, CV_8UC3), cv::NORM_INF), 0) << "frame " << index;
  }
}

TEST_F(VideoFile, OfAMovieDamagedInTheMiddleSaysSo) {
  test::write_clip(folder_ / "a.mp4", 50, kMovie);
  std::string bytes = read_bytes(folder_ / "a.mp4");
  for (std::size_t i = 0; i < 4000; ++i) bytes[bytes.size() / 2 + i] = static_cast<char>(i * 37);
  folder_.write("a.mp4", bytes);
  const Seen seen = look("a.mp4");
  EXPECT_GE(seen.frames.size(), 20u);
  ASSERT_TRUE(seen.fault);
  EXPECT_NE(seen.fault->find(" frames are damaged or missing, "), std::string::npos) << *seen.fault;
}

TEST_F(VideoFile, ThatWasNeverClosedIsReadableWithoutLossAndGoneAsAMovie) {
  {
    VideoWriter lossless(folder_ / "a.mkv", kSize, kLossless), movie(folder_ / "a.mp4", kSize, kMovie);
    for (int i = 0; i < 30; ++i) {
      lossless.write(test::clip_frame(i, kSize, CV_8UC3));
      movie.write(test::clip_frame(i, kSize, CV_8UC3));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.mkv"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.mp4"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.mp4.part"));
  const Seen seen = look("a.mkv.part");
  EXPECT_GE(seen.frames.size(), 25u);
  ASSERT_TRUE(seen.fault);
  EXPECT_EQ(*seen.fault, "a.mkv.part: was not closed when it was recorded, " + std::to_string(seen.frames.size()) +
                             " frames can be read");
}

TEST_F(VideoFile, ThatIsNoneIsNamed) {
  const auto message = [&](const char* name) {
    return test::message_of(folder_.path(), [&] { VideoReader(folder_ / name); });
  };
  folder_.write("poem.mp4", std::string(5000, 'x'));
  EXPECT_EQ(message("poem.mp4"),
            "poem.mp4: is no readable video: Invalid data found when processing input; convert it to MP4 or MKV, or "
            "record it again");
  EXPECT_EQ(message("none.mp4"),
            "none.mp4: is no readable video: No such file or directory; convert it to MP4 or MKV, or record it again");
  test::write_clip(folder_ / "a.mp4", 30, kMovie);
  cut("a.mp4", 0.01);  // within the index at the front
  EXPECT_NE(message("a.mp4").find("a.mp4: is no readable video"), std::string::npos) << message("a.mp4");
}

TEST_F(VideoFile, OnAFullDiskIsNotSilentlyShort) {
  for (const char* name : {"a.mp4", "a.mkv"}) {
    std::filesystem::create_symlink("/dev/full", folder_ / (std::string(name) + ".part"));
    EXPECT_EQ(
        test::message_of(
            folder_.path(),
            [&] { test::write_clip(folder_ / name, 60, std::string_view(name) == "a.mp4" ? kMovie : kLossless); }),
        std::string(name) + ": cannot be written: No space left on device; free some space and run it again");
    EXPECT_FALSE(std::filesystem::exists(folder_ / name));
  }
}

TEST_F(VideoFile, TellsWhenTheDiskFillsHalfWay) {
  for (const char* name : {"a.mp4", "a.mkv"}) {
    const test::FileSizeLimit limit(100'000);
    const bool movie = std::string_view(name) == "a.mp4";
    EXPECT_EQ(
        test::message_of(folder_.path(), [&] { test::write_clip(folder_ / name, 150, movie ? kMovie : kLossless); }),
        std::string(name) + ": cannot be written: File too large");
    EXPECT_FALSE(std::filesystem::exists(folder_ / name));
  }
}

TEST_F(VideoFile, RefusesOtherFramesThanTheFirst) {
  VideoWriter writer(folder_ / "a.mp4", kSize, kMovie);
  writer.write(cv::Mat(kSize, CV_8UC3, cv::Scalar::all(0)));
  EXPECT_THROW(writer.write(cv::Mat(kSize, CV_8UC1, cv::Scalar::all(0))), std::invalid_argument);
  EXPECT_THROW(writer.write(cv::Mat(8, 8, CV_8UC3)), std::invalid_argument);
  EXPECT_THROW(VideoWriter(folder_ / "b.mp4", {0, 5}), std::invalid_argument);
  EXPECT_THROW(VideoWriter(folder_ / "b.mp4", kSize, {VideoKind::Movie, 0.0, 20}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
