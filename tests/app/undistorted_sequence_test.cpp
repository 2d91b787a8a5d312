// SPDX-License-Identifier: Apache-2.0
#include "app/undistorted_sequence.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "capture/file_sources.h"
#include "io/camera_file.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

const Camera kPinhole{64, 48, 50, 51, 31.5, 23.5, {}, 0.02};

cv::Mat image_of_frame(int i) {
  return {48, 64, CV_8UC3, cv::Scalar(10 * i, 100, 50)};
}

std::filesystem::path write_two(const std::filesystem::path& out, SequenceForm form, bool has_times) {
  ResultDirectory directory(out, "undistort");
  UndistortedSequence sequence(directory, kPinhole, form, 25.0);
  sequence.add("b.bmp", Timestamp(1s), image_of_frame(1));
  sequence.add("a.jpg", Timestamp(1040ms), image_of_frame(2));
  EXPECT_EQ(sequence.count(), 2u);
  sequence.finish(has_times);
  directory.commit(nlohmann::json::object());
  return out;
}

TEST(UndistortedSequence, KeepsNamesAndOrderAndTimes) {
  const test::TemporaryDirectory temporary;
  const auto out = write_two(temporary / "s", SequenceForm::Images, true);
  EXPECT_EQ(read_camera(out / "camera.yaml"), kPinhole);
  const auto frames = open_files((out / "frames.csv").string());
  const auto first = frames->next(), second = frames->next();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->name, "b.png");  // nothing writes BMP
  EXPECT_EQ(second->name, "a.jpg");
  EXPECT_EQ(second->time, Timestamp(1040ms));
  EXPECT_EQ(cv::norm(first->image, image_of_frame(1), cv::NORM_INF), 0);
}

TEST(UndistortedSequence, ClaimsNoTimesWhereThereAreNone) {
  const test::TemporaryDirectory temporary;
  const auto out = write_two(temporary / "s", SequenceForm::Images, false);
  EXPECT_FALSE(std::filesystem::exists(out / "frames.csv"));
}

TEST(UndistortedSequence, IsAVideoWhereOneIsWanted) {
  const test::TemporaryDirectory temporary;
  const auto out = write_two(temporary / "s", SequenceForm::Lossless, true);
  const auto frames = open_files((out / "video.mkv").string());
  const auto first = frames->next();
  ASSERT_TRUE(first);
  EXPECT_EQ(cv::norm(first->image, image_of_frame(1), cv::NORM_INF), 0);
  EXPECT_TRUE(std::filesystem::exists(out / "frames.csv"));
}

TEST(UndistortedSequence, RefusesTwoImagesOfOneName) {
  const test::TemporaryDirectory temporary;
  ResultDirectory directory(temporary / "s", "undistort");
  UndistortedSequence sequence(directory, kPinhole, SequenceForm::Images, 25.0);
  sequence.add("a.bmp", Timestamp(), image_of_frame(1));
  EXPECT_EQ(test::message_of("", [&] { sequence.add("a.png", Timestamp(), image_of_frame(1)); }),
            "a.png: two images have this name; undistort their folders one by one");
}

}  // namespace
}  // namespace alidade
