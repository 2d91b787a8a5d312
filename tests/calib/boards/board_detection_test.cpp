// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board_detection.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/calib/boards/board_pictures.h"

namespace alidade {
namespace {

TEST(BoardDetection, FindsEveryKindInGreyAndColour) {
  for (const char* text : {"chessboard:9x6:25mm", "charuco:7x5:30mm:18mm:4X4_50", "aprilgrid:4x3:40mm:10mm"}) {
    const auto pictures = test::picture(text, 1, test::good_light());
    cv::Mat colour;
    cv::cvtColor(pictures.images[0], colour, cv::COLOR_GRAY2BGR);
    const auto from_grey = detect_board(pictures.images[0], pictures.board);
    const auto from_colour = detect_board(colour, pictures.board);
    ASSERT_TRUE(from_grey && from_colour) << text;
    EXPECT_EQ(from_grey->corners.size(), from_colour->corners.size());
    EXPECT_LT(pictures.errors(0, *from_grey).rms_px, 0.08) << text;
  }
}

TEST(BoardDetection, RefusesOtherImages) {
  EXPECT_THROW(detect_board(cv::Mat(48, 64, CV_16UC1, cv::Scalar()), Board{}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
