// SPDX-License-Identifier: Apache-2.0
#include "io/text_lines.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <system_error>

#include <fmt/format.h>

#include "core/errors.h"

namespace alidade {

std::string read_bytes(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError(path, 0, "is a folder, a file is wanted", "");
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) {
    throw InputError(path, 0, "cannot be opened: " + std::generic_category().message(errno), "check the name");
  }
  std::string bytes;
  char block[1 << 16];
  while (const std::size_t count = std::fread(block, 1, sizeof block, file.get())) bytes.append(block, count);
  if (std::ferror(file.get())) {
    throw InputError(path, 0, "cannot be read: " + std::generic_category().message(errno), "");
  }
  return bytes;
}

std::vector<TextLine> significant_lines(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<TextLine> lines;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trim(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (!line.empty() && line.front() != '#') lines.push_back({number, std::string(line)});
  }
  return lines;
}

std::vector<TextLine> read_lines(const std::filesystem::path& path) {
  return significant_lines(read_bytes(path));
}

std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string_view> split_words(std::string_view text) {
  std::vector<std::string_view> words;
  for (text = trim(text); !text.empty(); text = trim(text)) {
    const std::size_t end = text.find_first_of(" \t");
    words.push_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end);
  }
  return words;
}

double parse_number(const std::filesystem::path& path, int line, std::string_view word) {
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    throw InputError(path, line, fmt::format("'{}' is out of the range of numbers", word), "");
  }
  if (error != std::errc() || end != digits.data() + digits.size()) {
    throw InputError(path, line, fmt::format("'{}' is not a number", word), "");
  }
  if (!std::isfinite(value)) {
    throw InputError(path, line, fmt::format("'{}' is not a finite number", word), "");
  }
  return value;
}

long long parse_integer(const std::filesystem::path& path, int line, std::string_view word) {
  long long value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) {
    throw InputError(path, line, fmt::format("'{}' is not a whole number", word), "");
  }
  return value;
}

std::vector<double> parse_numbers(const std::filesystem::path& path, const TextLine& line) {
  std::vector<double> numbers;
  for (const std::string_view word : split_words(line.text)) numbers.push_back(parse_number(path, line.number, word));
  return numbers;
}

}  // namespace alidade
