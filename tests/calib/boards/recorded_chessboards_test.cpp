// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "calib/boards/chessboard_detection.h"
#include "calib/boards/chessboard_finder.h"
#include "io/image_files.h"
#include "tests/support/data_directory.h"

namespace alidade {
namespace {

// The images of a folder whose names start so, grey.
std::vector<cv::Mat> grey_images(const std::filesystem::path& folder, const std::string& start) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const bool is_wanted = entry.path().filename().string().starts_with(start);
    if (is_wanted && has_image_extension(entry.path())) paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  std::vector<cv::Mat> images;
  for (const auto& path : paths) {
    cv::Mat image = read_image(path);
    if (image.channels() == 3) cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
    images.push_back(image);
  }
  return images;
}

// Root mean square distance of corners and OpenCV's plain calibration (k1, k2, p1, p2, k3) by them, px; every image
// must show the board, or it is infinite.
double calibration_rms_px(const std::vector<cv::Mat>& images, const Board& board) {
  std::vector<std::vector<cv::Point3f>> objects;
  std::vector<std::vector<cv::Point2f>> pixels;
  const auto points = corners_m(board);
  for (const cv::Mat& image : images) {
    const auto view = detect_chessboard(image, board);
    if (!view) return std::numeric_limits<double>::infinity();
    objects.emplace_back();
    pixels.emplace_back();
    for (const BoardCorner& corner : view->corners) {
      const Eigen::Vector3f p = points[corner.id].cast<float>();
      objects.back().emplace_back(p.x(), p.y(), p.z());
      pixels.back().emplace_back(corner.pixel.cast<float>().x(), corner.pixel.cast<float>().y());
    }
  }
  cv::Mat K, distortion;
  std::vector<cv::Mat> rotations, translations;
  return cv::calibrateCamera(objects, pixels, images[0].size(), K, distortion, rotations, translations);
}

std::optional<GridSize> voted_size(const std::vector<cv::Mat>& images) {
  std::vector<ChessboardGrid> guesses;
  for (const cv::Mat& image : images) {
    if (auto guess = guess_chessboard(image)) guesses.push_back(std::move(*guess));
  }
  return most_common_size(guesses);
}

// OpenCV's tutorial (cornerSubPix with 11x11) leaves 0.408 px on the left images and 0.458 px on the right ones.
TEST(RecordedChessboards, OfAStereoPairAreAllFoundAndFitALens) {
  const auto folder = test::data_directory("chessboard-stereo");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  for (const std::string side : {"left", "right"}) {
    const auto images = grey_images(folder, side);
    ASSERT_EQ(images.size(), 13u);
    EXPECT_LT(calibration_rms_px(images, Board{.columns = 9, .rows = 6, .square_m = 0.025}), 0.17) << side;
  }
}

TEST(RecordedChessboards, OfAStereoPairTellTheirSize) {
  const auto folder = test::data_directory("chessboard-stereo");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  for (const std::string side : {"left", "right"}) {
    EXPECT_EQ(voted_size(grey_images(folder, side)), (GridSize{9, 6})) << side;
  }
}

// The published parameters leave 1.04 px on cornerSubPix' corners.
TEST(RecordedChessboards, OfABlurredVideoAreAllFoundAndFitALens) {
  const auto folder = test::data_directory("chessboard-sony");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const auto images = grey_images(folder, "00");
  ASSERT_EQ(images.size(), 20u);
  EXPECT_LT(calibration_rms_px(images, Board{.columns = 7, .rows = 6}), 1.0);
}

TEST(RecordedChessboards, OfABlurredVideoTellTheirSize) {
  const auto folder = test::data_directory("chessboard-sony");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  EXPECT_EQ(voted_size(grey_images(folder, "00")), (GridSize{7, 6}));
}

}  // namespace
}  // namespace alidade
