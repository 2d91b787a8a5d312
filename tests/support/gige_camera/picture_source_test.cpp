// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/picture_source.h"

#include <gtest/gtest.h>

#include "io/image_files.h"
#include "tests/support/input_error.h"
#include "tests/support/temporary_directory.h"

namespace alidade::test {
namespace {

TEST(PictureFolder, ShowsItsImagesInOrderOverAndOverOrOnce) {
  const TemporaryDirectory directory;
  for (const int i : {2, 10})
    write_image(directory.path() / fmt::format("{}.png", i), cv::Mat(4, 6, CV_8UC1, cv::Scalar(i)));
  const auto endless = open_picture_folder(directory.path(), true);
  EXPECT_EQ(endless->picture_at(3), 1U);
  EXPECT_EQ(endless->picture(1, {1, 1, 2, 2}, {}).at<std::uint8_t>(0, 0), 10);
  EXPECT_EQ(open_picture_folder(directory.path(), false)->picture_at(2), std::nullopt);
  EXPECT_EQ(picture_size(directory.path()), cv::Size(6, 4));
}

TEST(PictureFolder, SamplesColoursAndScalesValues) {
  const TemporaryDirectory directory;
  write_image(directory.path() / "1.png", cv::Mat(2, 2, CV_8UC3, cv::Scalar(10, 20, 30)));
  const auto folder = open_picture_folder(directory.path(), true);
  const cv::Mat mosaic = folder->picture(0, {0, 0, 2, 2}, {PixelKind::Bayer, 8, BayerPattern::GRBG});
  EXPECT_EQ(cv::countNonZero(mosaic != (cv::Mat_<std::uint8_t>(2, 2) << 20, 30, 10, 20)), 0);
  const cv::Mat deep = folder->picture(0, {0, 0, 2, 2}, {PixelKind::Bayer, 12, BayerPattern::GRBG});
  EXPECT_EQ(deep.at<std::uint16_t>(0, 1), 30 * 16);
}

TEST(PictureFolder, RefusesImagesOfSeveralSizes) {
  const TemporaryDirectory directory;
  write_image(directory.path() / "1.png", cv::Mat::zeros(2, 2, CV_8UC1));
  write_image(directory.path() / "2.png", cv::Mat::zeros(3, 2, CV_8UC1));
  EXPECT_EQ(message_of(directory.path(), [&] { open_picture_folder(directory.path(), true); }),
            "2.png: is of another size than the first image of the folder; keep images of one size there");
}

}  // namespace
}  // namespace alidade::test
