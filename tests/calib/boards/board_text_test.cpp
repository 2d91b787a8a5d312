// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board_text.h"

#include <gtest/gtest.h>

#include "tests/support/input_error.h"

namespace alidade {
namespace {

std::string refusal(const std::string& text) {
  return test::message_of("", [&] { parse_board(text); });
}

TEST(BoardText, ReadsEveryKind) {
  EXPECT_EQ(parse_board("chessboard:9x6:25mm"), (Board{BoardKind::Chessboard, 9, 6, 0.025}));
  EXPECT_EQ(parse_board("charuco:8x6:3cm:22mm:5X5_100:marker-first"),
            (Board{BoardKind::Charuco, 8, 6, 0.03, 0.022, 0, "5X5_100", CharucoLayout::MarkerFirst}));
  EXPECT_EQ(parse_board("aprilgrid:6x6:0.088m:26.4mm"),
            (Board{BoardKind::AprilGrid, 6, 6, 0.088, 0, 0.0264, "APRILTAG_36h11"}));
}

TEST(BoardText, ReadsWhatItWrites) {
  for (const char* text : {"chessboard:9x6:25mm", "chessboard:11x8:30.48mm", "charuco:8x6:30mm:22mm:5X5_100",
                           "charuco:7x5:12.345mm:9.1mm:4X4_50:marker-first", "aprilgrid:6x6:88mm:26.4mm",
                           "aprilgrid:3x2:1200mm:300mm:APRILTAG_25h9"}) {
    EXPECT_EQ(board_text(parse_board(text)), text);
    EXPECT_EQ(parse_board(board_text(parse_board(text))), parse_board(text));
  }
}

TEST(BoardText, SaysWhatIsWrongAndHowItIsWritten) {
  EXPECT_EQ(refusal("chesboard:9x6:25mm"),
            "chesboard:9x6:25mm: unknown kind of board 'chesboard'; did you mean 'chessboard'?, as in "
            "'chessboard:9x6:25mm'");
  EXPECT_EQ(refusal("chessboard:9x6"), "chessboard:9x6: 1 of 3 words are missing; write it as 'chessboard:9x6:25mm'");
  EXPECT_EQ(refusal("chessboard:9-6:25mm"),
            "chessboard:9-6:25mm: a size is COLUMNSxROWS, got '9-6'; write it as 'chessboard:9x6:25mm'");
  EXPECT_EQ(refusal("chessboard:9x6:25"),
            "chessboard:9x6:25: the length '25' has no unit; units are mm, cm and m, as in 'chessboard:9x6:25mm'");
  EXPECT_EQ(refusal("chessboard:9x6:1in"),
            "chessboard:9x6:1in: unknown unit 'in' of the length '1in'; units are mm, cm and m, as in "
            "'chessboard:9x6:25mm'");
  EXPECT_EQ(refusal("chessboard:2x6:25mm"),
            "chessboard:2x6:25mm: a board has at least 3x3 inner corners, got 2x6; write it as 'chessboard:9x6:25mm'");
  EXPECT_EQ(refusal("chessboard:9x6:25mm:5X5_100"),
            "chessboard:9x6:25mm:5X5_100: '5X5_100' is too much; write it as 'chessboard:9x6:25mm'");
}

TEST(BoardText, SaysWhatIsWrongWithMarkers) {
  EXPECT_EQ(refusal("charuco:8x6:30mm:22mm:5X5_10"),
            "charuco:8x6:30mm:22mm:5X5_10: unknown dictionary of markers '5X5_10'; did you mean '5X5_50'?");
  EXPECT_EQ(refusal("charuco:8x6:30mm:33mm:5X5_100"),
            "charuco:8x6:30mm:33mm:5X5_100: the side of a marker must lie between 0 and that of a square, 0.03 m, got "
            "0.033; write it as 'charuco:8x6:30mm:22mm:5X5_100'");
  EXPECT_EQ(refusal("charuco:8x6:30mm:22mm:5X5_100:white-first"),
            "charuco:8x6:30mm:22mm:5X5_100:white-first: unknown layout 'white-first'; the only word there is "
            "'marker-first'");
  EXPECT_EQ(refusal("charuco:12x9:30mm:22mm:5X5_50"),
            "charuco:12x9:30mm:22mm:5X5_50: the board needs 54 markers, 5X5_50 has 50; take a larger dictionary or a "
            "smaller board");
}

}  // namespace
}  // namespace alidade
