// SPDX-License-Identifier: Apache-2.0
#include "io/text_rows.h"

#include <string_view>

#include "io/text_lines.h"

namespace alidade {
namespace {

std::vector<std::string> split_at_commas(std::string_view text) {
  std::vector<std::string> fields;
  for (;;) {
    const std::size_t comma = text.find(',');
    fields.emplace_back(trim(text.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    text.remove_prefix(comma + 1);
  }
}

std::vector<std::string> split_at_blanks(std::string_view text) {
  const std::vector<std::string_view> words = split_words(text);
  return {words.begin(), words.end()};
}

}  // namespace

std::vector<TextRow> read_rows(const std::filesystem::path& path) {
  std::vector<TextRow> rows;
  for (const TextLine& line : read_lines(path)) {
    const bool commas = line.text.find(',') != std::string::npos;
    rows.push_back({line.number, commas, commas ? split_at_commas(line.text) : split_at_blanks(line.text)});
  }
  return rows;
}

double finite_number(const std::filesystem::path& path, const TextRow& row, std::size_t column) {
  return parse_number(path, row.line, row.fields.at(column));
}

}  // namespace alidade
