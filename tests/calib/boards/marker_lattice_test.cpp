// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/marker_lattice.h"

#include <gtest/gtest.h>

#include "calib/boards/board_pattern.h"
#include "calib/boards/board_text.h"
#include "calib/boards/placed_markers.h"

namespace alidade {
namespace {

std::vector<FoundMarker> seen_markers(const Board& board) {
  Eigen::Matrix3d H;
  H << 1500, 200, 320, -100, 1400, 240, 0.4, -0.3, 1;
  std::vector<FoundMarker> found;
  for (const BoardMarker& marker : markers(board)) {
    FoundMarker seen{marker.id, {}};
    for (std::size_t c = 0; c < 4; ++c) seen.corners[c] = map_by(H, marker.corners[c]);
    found.push_back(seen);
  }
  return found;
}

std::optional<Board> explained(const std::vector<FoundMarker>& found) {
  const auto lattice = find_lattice(found);
  if (!lattice) return std::nullopt;
  return explain_lattice({&*lattice, 1});
}

TEST(MarkerLattice, TellsTheBoardByTheIdsOfNeighbours) {
  for (const char* text : {"charuco:8x6:30mm:20mm:5X5_100", "charuco:7x6:30mm:20mm:5X5_100:marker-first",
                           "charuco:5x9:30mm:24mm:5X5_100", "aprilgrid:6x4:30mm:9mm"}) {
    const Board truth = parse_board(text);
    const auto board = explained(seen_markers(truth));
    ASSERT_TRUE(board) << text;
    EXPECT_EQ(board->kind, truth.kind) << text;
    EXPECT_EQ(board->columns, truth.columns) << text;
    EXPECT_EQ(board->rows, truth.rows) << text;
    EXPECT_EQ(board->layout, truth.layout) << text;
    EXPECT_NEAR(board->marker_m / board->square_m, truth.marker_m / truth.square_m, 0.02) << text;
    EXPECT_NEAR(board->gap_m / board->square_m, truth.gap_m / truth.square_m, 0.02) << text;
  }
}

TEST(MarkerLattice, TellsTheBoardByAPartOfIt) {
  auto found = seen_markers(parse_board("charuco:8x6:30mm:20mm:5X5_100"));
  found.erase(found.begin(), found.begin() + 8);
  found.erase(found.begin() + 9);
  const auto board = explained(found);
  ASSERT_TRUE(board);
  EXPECT_EQ(board->columns, 8);
  EXPECT_EQ(board->rows, 6);
}

TEST(MarkerLattice, IsNotTakenInByRandomIds) {
  auto found = seen_markers(parse_board("charuco:8x6:30mm:20mm:5X5_100"));
  for (std::size_t i = 0; i < found.size(); ++i) found[i].id = static_cast<int>(i * 37 % 101);
  EXPECT_FALSE(explained(found));
  EXPECT_FALSE(find_lattice({found.data(), 3}));
  EXPECT_FALSE(explain_lattice({}));
}

}  // namespace
}  // namespace alidade
