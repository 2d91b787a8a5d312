// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/marker_dictionary.h"

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>

namespace alidade {
namespace {

TEST(MarkerDictionary, NamesAreThoseOfOpenCv) {
  EXPECT_EQ(marker_dictionary_number("4X4_50"), cv::aruco::DICT_4X4_50);
  EXPECT_EQ(marker_dictionary_number("7X7_1000"), cv::aruco::DICT_7X7_1000);
  EXPECT_EQ(marker_dictionary_number("APRILTAG_36h11"), cv::aruco::DICT_APRILTAG_36h11);
  EXPECT_EQ(marker_dictionary_size("5X5_250"), 250);
  EXPECT_EQ(marker_dictionary_size("APRILTAG_36h11"), 587);
  EXPECT_THROW(marker_dictionary_number("5X5"), std::invalid_argument);
}

TEST(MarkerDictionary, CellsAreThoseThatOpenCvDraws) {
  constexpr int kId = 17, kCells = 8;
  cv::Mat drawn;
  cv::aruco::drawMarker(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11), kId, kCells, drawn);
  EXPECT_EQ(cv::norm(marker_cells("APRILTAG_36h11", kId), drawn, cv::NORM_INF), 0);
  EXPECT_THROW(marker_cells("APRILTAG_36h11", 587), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
