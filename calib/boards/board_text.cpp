// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/board_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "calib/boards/board_pattern.h"
#include "calib/boards/marker_dictionary.h"
#include "core/errors.h"
#include "core/nearest_name.h"

namespace alidade {
namespace {

constexpr std::array<std::string_view, 3> kKinds{"chessboard", "charuco", "aprilgrid"};
constexpr std::array<std::string_view, 3> kExamples{"chessboard:9x6:25mm", "charuco:8x6:30mm:22mm:5X5_100",
                                                    "aprilgrid:6x6:88mm:26.4mm"};
constexpr std::string_view kMarkerFirst = "marker-first";
constexpr std::string_view kUsualTags = "APRILTAG_36h11";

// The words between the colons, and the complaint about any of them.
struct BoardWords {
  std::string text;
  std::vector<std::string_view> words;
  BoardKind kind = BoardKind::Chessboard;

  InputError refuse(const std::string& what, const std::string& remedy = "") const {
    const std::string example = fmt::format("write it as '{}'", kExamples[static_cast<std::size_t>(kind)]);
    return {text, 0, what, remedy.empty() ? example : remedy};
  }
};

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t colon = text.find(':'); colon != std::string_view::npos; colon = text.find(':')) {
    words.push_back(text.substr(0, colon));
    text.remove_prefix(colon + 1);
  }
  words.push_back(text);
  return words;
}

// The number at the start of `word`, which loses it; empty where there is none.
template <class Number>
std::optional<Number> take_number(std::string_view& word) {
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc()) return std::nullopt;
  word.remove_prefix(static_cast<std::size_t>(end - word.data()));
  return number;
}

std::array<int, 2> parse_size(const BoardWords& board, std::string_view word) {
  std::string_view rest = word;
  const auto columns = take_number<int>(rest);
  const bool has_x = columns && !rest.empty() && (rest.front() == 'x' || rest.front() == 'X');
  if (has_x) rest.remove_prefix(1);
  const auto rows = has_x ? take_number<int>(rest) : std::nullopt;
  if (!rows || !rest.empty()) throw board.refuse(fmt::format("a size is COLUMNSxROWS, got '{}'", word));
  return {*columns, *rows};
}

double parse_length(const BoardWords& board, std::string_view word) {
  std::string_view unit = word;
  const auto number = take_number<double>(unit);
  if (!number) throw board.refuse(fmt::format("a length is a number with mm, cm or m, got '{}'", word));
  // Divided, as 25 / 1000.0 is the number nearest to 0.025, and 25 * 0.001 need not be.
  if (unit == "mm") return *number / 1000.0;
  if (unit == "cm") return *number / 100.0;
  if (unit == "m") return *number;
  throw board.refuse(
      unit.empty() ? fmt::format("the length '{}' has no unit", word)
                   : fmt::format("unknown unit '{}' of the length '{}'", unit, word),
      fmt::format("units are mm, cm and m, as in '{}'", kExamples[static_cast<std::size_t>(board.kind)]));
}

std::string parse_dictionary(const BoardWords& board, std::string_view word) {
  const auto names = marker_dictionary_names();
  if (std::find(names.begin(), names.end(), word) != names.end()) return std::string(word);
  throw board.refuse(fmt::format("unknown dictionary of markers '{}'", word), suggest_name(word, names));
}

BoardKind parse_kind(const BoardWords& board, std::string_view word) {
  const auto found = std::find(kKinds.begin(), kKinds.end(), word);
  if (found != kKinds.end()) return static_cast<BoardKind>(found - kKinds.begin());
  const auto nearest = nearest_name(word, kKinds);
  const auto example = nearest ? std::find(kKinds.begin(), kKinds.end(), *nearest) - kKinds.begin() : 0;
  throw board.refuse(
      fmt::format("unknown kind of board '{}'", word),
      fmt::format("{}, as in '{}'", suggest_name(word, kKinds), kExamples[static_cast<std::size_t>(example)]));
}

Board read_words(const BoardWords& given) {
  constexpr std::array<std::array<std::size_t, 2>, 3> kWordCounts{{{3, 3}, {5, 6}, {4, 5}}};
  const auto [least, most] = kWordCounts[static_cast<std::size_t>(given.kind)];
  const auto& words = given.words;
  if (words.size() < least) throw given.refuse(fmt::format("{} of {} words are missing", least - words.size(), least));
  if (words.size() > most) throw given.refuse(fmt::format("'{}' is too much", words[most]));
  const auto [columns, rows] = parse_size(given, words[1]);
  Board board{given.kind, columns, rows, parse_length(given, words[2])};
  if (given.kind == BoardKind::Charuco) {
    board.marker_m = parse_length(given, words[3]);
    board.dictionary = parse_dictionary(given, words[4]);
    if (words.size() == most && words[5] != kMarkerFirst) {
      throw given.refuse(fmt::format("unknown layout '{}'", words[5]),
                         fmt::format("the only word there is '{}'", kMarkerFirst));
    }
    if (words.size() == most) board.layout = CharucoLayout::MarkerFirst;
  } else if (given.kind == BoardKind::AprilGrid) {
    board.gap_m = parse_length(given, words[3]);
    board.dictionary = parse_dictionary(given, words.size() == most ? words[4] : kUsualTags);
  }
  return board;
}

}  // namespace

Board parse_board(const std::string& text) {
  BoardWords given{text, split(text)};
  given.kind = parse_kind(given, given.words.front());
  const Board board = read_words(given);
  if (const auto fault = find_fault(board)) throw given.refuse(*fault);
  if (board.kind == BoardKind::Chessboard) return board;
  const int has = marker_dictionary_size(board.dictionary);
  if (marker_count(board) > has) {
    throw given.refuse(fmt::format("the board needs {} markers, {} has {}", marker_count(board), board.dictionary, has),
                       "take a larger dictionary or a smaller board");
  }
  return board;
}

std::string board_text(const Board& board) {
  const auto mm = [](double length_m) { return fmt::format("{:.9g}mm", 1e3 * length_m); };
  std::string text = fmt::format("{}:{}x{}:{}", kKinds[static_cast<std::size_t>(board.kind)], board.columns, board.rows,
                                 mm(board.square_m));
  if (board.kind == BoardKind::Charuco) {
    text += fmt::format(":{}:{}", mm(board.marker_m), board.dictionary);
    if (board.layout == CharucoLayout::MarkerFirst) text += fmt::format(":{}", kMarkerFirst);
  } else if (board.kind == BoardKind::AprilGrid) {
    text += fmt::format(":{}", mm(board.gap_m));
    if (board.dictionary != kUsualTags) text += fmt::format(":{}", board.dictionary);
  }
  return text;
}

}  // namespace alidade
