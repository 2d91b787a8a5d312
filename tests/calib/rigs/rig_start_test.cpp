// SPDX-License-Identifier: Apache-2.0
#include "calib/rigs/rig_start.h"

#include <vector>

#include <gtest/gtest.h>

#include "geometry/pose.h"
#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

// Boards at eight moments, and cameras that see them from poses of theirs.
struct Rig {
  std::vector<Eigen::Isometry3d> T_rig_camera, T_rig_board;

  PlacedBoard placed(int camera, int frame, int corners = 54) const {
    return {frame,
            T_rig_camera[static_cast<std::size_t>(camera)].inverse() * T_rig_board[static_cast<std::size_t>(frame)],
            corners};
  }
  std::vector<PlacedBoard> placed_in(int camera, const std::vector<int>& frames) const {
    std::vector<PlacedBoard> boards;
    for (const int frame : frames) boards.push_back(placed(camera, frame));
    return boards;
  }
};

Rig make_rig() {
  test::RandomGeometry random(3);
  Rig rig;
  rig.T_rig_camera = {Eigen::Isometry3d::Identity(), random.pose(), random.pose(), random.pose()};
  for (int i = 0; i < 8; ++i) rig.T_rig_board.push_back(random.pose());
  return rig;
}

using Chained = std::variant<std::vector<Eigen::Isometry3d>, Untied>;

void expect_poses(const Rig& rig, const Chained& chained) {
  const auto* poses = std::get_if<std::vector<Eigen::Isometry3d>>(&chained);
  ASSERT_TRUE(poses);
  ASSERT_EQ(poses->size(), rig.T_rig_camera.size());
  for (std::size_t i = 0; i < poses->size(); ++i) {
    EXPECT_LT(difference(rig.T_rig_camera[i], (*poses)[i]).norm(), 1e-12) << i;
  }
}

// 0 - 3 - 1 - 2: the first and the second never look at once.
TEST(ChainCameras, GoesFromPairToPair) {
  const Rig rig = make_rig();
  const std::vector<std::vector<PlacedBoard>> boards{rig.placed_in(0, {0, 1}), rig.placed_in(1, {2, 3, 4}),
                                                     rig.placed_in(2, {4, 5}), rig.placed_in(3, {1, 2, 7})};
  expect_poses(rig, chain_cameras(boards));
}

// The first camera's board at moment 2 is flipped, as of a plane seen from afar; all others agree.
TEST(ChainCameras, TakesThePoseThatMostMomentsAgreeWith) {
  const Rig rig = make_rig();
  std::vector<std::vector<PlacedBoard>> boards;
  for (int camera = 0; camera < 4; ++camera) boards.push_back(rig.placed_in(camera, {2, 3, 4, 5}));
  boards[0][0].T_camera_board.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()));
  expect_poses(rig, chain_cameras(boards));
}

// By way of the third camera two moments tie the second one, directly only one, whose board was placed wrongly.
TEST(ChainCameras, PrefersTheTieOfMostMoments) {
  Rig rig = make_rig();
  rig.T_rig_camera.resize(3);
  std::vector<std::vector<PlacedBoard>> boards{rig.placed_in(0, {0, 1, 2}), rig.placed_in(1, {2, 5, 6}),
                                               rig.placed_in(2, {0, 1, 5, 6})};
  boards[0][2].T_camera_board.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()));
  expect_poses(rig, chain_cameras(boards));
}

TEST(ChainCameras, NamesThoseThatNothingTies) {
  const Rig rig = make_rig();
  const std::vector<std::vector<PlacedBoard>> boards{rig.placed_in(0, {0, 1}), rig.placed_in(1, {2, 3}),
                                                     rig.placed_in(2, {0, 5}), rig.placed_in(3, {3})};
  const auto chained = chain_cameras(boards);
  ASSERT_TRUE(std::holds_alternative<Untied>(chained));
  EXPECT_EQ(std::get<Untied>(chained).cameras, (std::vector<int>{1, 3}));
}

TEST(ChainCameras, OfOneIsItsOwnFrame) {
  Rig rig = make_rig();
  rig.T_rig_camera.resize(1);
  expect_poses(rig, chain_cameras(std::vector<std::vector<PlacedBoard>>{rig.placed_in(0, {0})}));
}

TEST(PlaceFrames, GoesByTheCameraThatSawMostCorners) {
  const Rig rig = make_rig();
  std::vector<std::vector<PlacedBoard>> boards{{rig.placed(0, 0, 54), rig.placed(0, 1, 10)},
                                               {rig.placed(1, 1, 30), rig.placed(1, 3, 6)}};
  boards[0][1].T_camera_board.translation().x() += 1;  // seen by its few corners, wrongly
  const auto T_rig_board = place_frames(boards, rig.T_rig_camera, 5);
  ASSERT_EQ(T_rig_board.size(), 5U);
  for (const std::size_t frame : {0U, 1U, 3U}) {
    EXPECT_LT(difference(rig.T_rig_board[frame], T_rig_board[frame]).norm(), 1e-12) << frame;
  }
  EXPECT_TRUE(T_rig_board[2].isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_TRUE(T_rig_board[4].isApprox(Eigen::Isometry3d::Identity()));
}

}  // namespace
}  // namespace alidade
