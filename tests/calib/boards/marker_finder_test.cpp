// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/marker_finder.h"

#include <gtest/gtest.h>

#include "tests/calib/boards/board_pictures.h"

namespace alidade {
namespace {

TEST(MarkerFinder, SeesMarkersByIdWithTheirCorners) {
  const auto pictures = test::picture("charuco:7x5:30mm:18mm:4X4_50", 1, test::good_light());
  const auto found = find_markers(pictures.images[0], {"4X4_50", 1, false, 17});
  ASSERT_EQ(found.size(), 17u);
  const auto on_board = markers(pictures.board);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].id, static_cast<int>(i));
    const Eigen::Vector2d p = on_board[i].corners[1];
    const auto truth = project(pictures.camera, pictures.poses[0] * Eigen::Vector3d(p.x(), p.y(), 0));
    EXPECT_LT((found[i].corners[1] - truth->pixel).norm(), 2.0) << i;
  }
}

TEST(MarkerFinder, PartsTagsThatTouch) {
  const auto pictures = test::picture("aprilgrid:6x6:24mm:6mm", 1, test::good_light());
  EXPECT_GE(find_markers(pictures.images[0], {"APRILTAG_36h11", 1, true, 36}).size(), 34u);
}

TEST(MarkerFinder, RefusesColourAndUnknownDictionaries) {
  EXPECT_THROW(find_markers(cv::Mat(8, 8, CV_8UC3, cv::Scalar()), {"4X4_50"}), std::invalid_argument);
  EXPECT_THROW(find_markers(cv::Mat(80, 80, CV_8UC1, cv::Scalar()), {"4X4"}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
