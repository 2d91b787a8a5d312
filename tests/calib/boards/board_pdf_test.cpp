// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board_pdf.h"

#include <sstream>

#include <gtest/gtest.h>

#include "calib/boards/board_pattern.h"
#include "calib/boards/board_text.h"
#include "tests/support/input_error.h"

namespace alidade {
namespace {

// The rectangles of the page in mm.
std::vector<Eigen::AlignedBox2d> rectangles(const std::string& pdf) {
  std::vector<Eigen::AlignedBox2d> boxes;
  std::istringstream lines(pdf);
  for (std::string line; std::getline(lines, line);) {
    if (!line.ends_with(" re")) continue;
    std::istringstream numbers(line);
    double x = 0, y = 0, width = 0, height = 0;
    numbers >> x >> y >> width >> height;
    boxes.emplace_back(Eigen::Vector2d(x, y), Eigen::Vector2d(x + width, y + height));
  }
  return boxes;
}

bool has(const std::string& pdf, const std::string& words) {
  return pdf.find(words) != std::string::npos;
}

TEST(BoardPdf, HasTheBoardToScale) {
  const Board board = parse_board("charuco:8x6:30mm:22mm:5X5_100");
  const BoardPattern pattern = pattern_of(board);
  const auto boxes = rectangles(board_pdf(board));
  ASSERT_EQ(boxes.size(), pattern.black.size() + 12);  // the ruler: a line and 11 marks
  const Eigen::Vector2d start = boxes[0].min() - 1e3 * pattern.black[0].min();
  for (std::size_t i = 0; i < pattern.black.size(); ++i) {
    EXPECT_LT((boxes[i].min() - start - 1e3 * pattern.black[i].min()).norm(), 1e-4);
    EXPECT_LT((boxes[i].sizes() - 1e3 * pattern.black[i].sizes()).norm(), 1e-4);
  }
  EXPECT_NEAR(boxes[pattern.black.size()].sizes().x(), 100, 1e-9);
}

TEST(BoardPdf, TurnsThePageWhereTheBoardNeedsIt) {
  EXPECT_TRUE(has(board_pdf(parse_board("chessboard:5x8:25mm")), "/MediaBox [0 0 595.2756 841.8898]"));
  EXPECT_TRUE(has(board_pdf(parse_board("chessboard:9x6:25mm")), "/MediaBox [0 0 841.8898 595.2756]"));
  EXPECT_TRUE(has(board_pdf(parse_board("chessboard:9x6:25mm"), Paper::Letter), "/MediaBox [0 0 792.0000 612.0000]"));
}

TEST(BoardPdf, FitsItsPageToTheBoard) {  // 240 + 16 by 240 + 16 + 14 mm
  EXPECT_TRUE(has(board_pdf(parse_board("chessboard:7x7:30mm"), Paper::Fitted), "/MediaBox [0 0 725.6693 765.3543]"));
}

TEST(BoardPdf, NamesThePaperThatWouldDo) {
  const auto refusal = [](const char* text) { return test::message_of("", [&] { board_pdf(parse_board(text)); }); };
  EXPECT_EQ(refusal("chessboard:9x6:40mm"),
            "chessboard:9x6:40mm: the board needs a page of 416 x 310 mm, A4 has 210 x 297; print it with --paper A2");
  EXPECT_EQ(refusal("chessboard:9x6:1m"),
            "chessboard:9x6:1000mm: the board needs a page of 10016 x 7030 mm, A4 has 210 x 297; print it with --paper "
            "fitted");
}

TEST(BoardPdf, SaysWhereItsObjectsAre) {
  const std::string pdf = board_pdf(parse_board("chessboard:9x6:25mm"));
  const std::size_t table = std::stoul(pdf.substr(pdf.find("startxref\n") + 10));
  EXPECT_EQ(pdf.compare(table, 5, "xref\n"), 0);
  const std::string first = pdf.substr(table);
  for (int i = 1; i <= 5; ++i) {
    const std::size_t row = first.find("65535 f \n") + 9 + 20 * static_cast<std::size_t>(i - 1);
    const std::size_t start = std::stoul(first.substr(row, 10));
    EXPECT_EQ(pdf.compare(start, 7, std::to_string(i) + " 0 obj"), 0);
  }
}

}  // namespace
}  // namespace alidade
