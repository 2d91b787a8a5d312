// SPDX-License-Identifier: Apache-2.0
#include "datasets/board_poses.h"

#include <set>

#include <gtest/gtest.h>

namespace alidade {
namespace {

const Camera kCamera{640, 480, 520, 520, 319.5, 239.5, BrownConrady{-0.25, 0.08}};
const Eigen::AlignedBox2d kExtent(Eigen::Vector2d(-0.025, -0.025), Eigen::Vector2d(0.225, 0.15));

std::vector<Eigen::Vector2d> rim_pixels(const Eigen::Isometry3d& T_camera_board) {
  std::vector<Eigen::Vector2d> pixels;
  for (const auto corner : {Eigen::AlignedBox2d::BottomLeft, Eigen::AlignedBox2d::BottomRight,
                            Eigen::AlignedBox2d::TopLeft, Eigen::AlignedBox2d::TopRight}) {
    const Eigen::Vector2d p = kExtent.corner(corner);
    pixels.push_back(project(kCamera, T_camera_board * Eigen::Vector3d(p.x(), p.y(), 0))->pixel);
  }
  return pixels;
}

TEST(BoardPoses, ShowTheWholeBoardFromItsFront) {
  for (const auto& T_camera_board : board_poses(kCamera, kExtent, 60, 3)) {
    for (const auto& pixel : rim_pixels(T_camera_board)) EXPECT_TRUE(is_inside(kCamera, pixel, 4)) << pixel.transpose();
    EXPECT_GT(T_camera_board.linear()(2, 2), std::cos(46 * 0.01745));  // tilted by 45 degrees at most
  }
}

TEST(BoardPoses, CoverTheImageAndTheTilts) {
  std::set<int> cells;
  double least_cosine = 1, nearest = 1e9, farthest = 0;
  for (const auto& T_camera_board : board_poses(kCamera, kExtent, 40, 4)) {
    for (const auto& pixel : rim_pixels(T_camera_board)) {
      cells.insert(static_cast<int>(pixel.x() / 160) + 4 * static_cast<int>(pixel.y() / 160));
    }
    least_cosine = std::min(least_cosine, T_camera_board.linear()(2, 2));
    nearest = std::min(nearest, T_camera_board.translation().z());
    farthest = std::max(farthest, T_camera_board.translation().z());
  }
  EXPECT_EQ(cells.size(), 12u);
  EXPECT_LT(least_cosine, std::cos(40 * 0.01745));
  EXPECT_GT(farthest, 1.7 * nearest);
}

TEST(BoardPoses, MayLeaveAPartOutside) {
  BoardPoseOptions options;
  options.partial = true;
  int outside = 0;
  for (const auto& T_camera_board : board_poses(kCamera, kExtent, 20, 5, options)) {
    for (const auto& pixel : rim_pixels(T_camera_board)) outside += is_inside(kCamera, pixel) ? 0 : 1;
  }
  EXPECT_GT(outside, 10);
}

TEST(BoardPoses, AreThoseOfTheirSeed) {
  const auto a = board_poses(kCamera, kExtent, 3, 7), b = board_poses(kCamera, kExtent, 3, 7);
  EXPECT_EQ(a[2].matrix(), b[2].matrix());
  EXPECT_NE(a[2].matrix(), board_poses(kCamera, kExtent, 3, 8)[2].matrix());
}

TEST(BoardPoses, RefuseWhatCannotBe) {
  BoardPoseOptions options;
  options.most_tilt_deg = 90;
  EXPECT_THROW(board_poses(kCamera, kExtent, 1, 1, options), std::invalid_argument);
  EXPECT_THROW(board_poses(kCamera, {}, 1, 1), std::invalid_argument);
  EXPECT_THROW(board_poses(kCamera, kExtent, -1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
