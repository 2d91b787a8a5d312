// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board.h"

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(BoardCorners, RunRowByRow) {
  const Board board{BoardKind::Chessboard, 4, 3, 0.02};
  const auto corners = corners_m(board);
  ASSERT_EQ(static_cast<int>(corners.size()), corner_count(board));
  EXPECT_TRUE(corners[5].isApprox(Eigen::Vector3d(0.02, 0.02, 0)));
}

TEST(BoardCorners, OfATagRunClockwise) {
  const Board board{BoardKind::AprilGrid, 2, 2, 0.08, 0, 0.02, "APRILTAG_36h11"};
  const auto corners = corners_m(board);
  ASSERT_EQ(static_cast<int>(corners.size()), corner_count(board));
  EXPECT_TRUE(corners[4].isApprox(Eigen::Vector3d(0.1, 0, 0)));
  EXPECT_TRUE(corners[5].isApprox(Eigen::Vector3d(0.18, 0, 0)));
  EXPECT_TRUE(corners[6].isApprox(Eigen::Vector3d(0.18, 0.08, 0)));
  EXPECT_TRUE(corners[7].isApprox(Eigen::Vector3d(0.1, 0.08, 0)));
}

TEST(BoardFault, NamesWhatIsImpossible) {
  EXPECT_FALSE(find_fault(Board{}));
  EXPECT_EQ(find_fault(Board{BoardKind::Chessboard, 2, 6}), "a board has at least 3x3 inner corners, got 2x6");
  EXPECT_EQ(find_fault(Board{BoardKind::Chessboard, 9, 6, 0}), "the side of a square must be > 0 m, got 0");
  EXPECT_EQ(find_fault(Board{BoardKind::Charuco, 9, 6, 0.02, 0.03}),
            "the side of a marker must lie between 0 and that of a square, 0.02 m, got 0.03");
}

}  // namespace
}  // namespace alidade
