// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace alidade {

/// A line of a text file that says something, and its number counted from 1.
struct TextLine {
  int number = 0;
  std::string text;
};

/// The bytes of a file. Throws InputError where it cannot be read.
std::string read_bytes(const std::filesystem::path& path);

/// The lines of `text` without line ends (LF, CRLF), blank lines, lines whose first character is '#', and a UTF-8 mark.
std::vector<TextLine> significant_lines(std::string_view text);

/// significant_lines of a file. Throws InputError where it cannot be read.
std::vector<TextLine> read_lines(const std::filesystem::path& path);

/// The words of a line, parted by blanks and tabs. They point into `text`.
std::vector<std::string_view> split_words(std::string_view text);

/// `text` without blanks at its ends. Points into `text`.
std::string_view trim(std::string_view text);

/// The finite number that `word` spells. Throws InputError("path:line: 'word' is not a number").
double parse_number(const std::filesystem::path& path, int line, std::string_view word);

/// The whole number that `word` spells. Throws InputError("path:line: 'word' is not a whole number").
long long parse_integer(const std::filesystem::path& path, int line, std::string_view word);

/// All words of a line as finite numbers. Throws InputError where one is not.
std::vector<double> parse_numbers(const std::filesystem::path& path, const TextLine& line);

}  // namespace alidade
