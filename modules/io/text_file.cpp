// SPDX-License-Identifier: Apache-2.0
#include "io/text_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include "core/errors.h"

namespace alidade {
namespace {

constexpr std::string_view kSpace = " \t\r\f\v";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::vector<std::string> split_at_commas(std::string_view text) {
  std::vector<std::string> fields;
  for (;;) {
    const std::size_t comma = text.find(',');
    fields.emplace_back(trimmed(text.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    text.remove_prefix(comma + 1);
  }
}

std::vector<std::string> split_at_space(std::string_view text) {
  std::vector<std::string> fields;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::size_t end = std::min(text.find_first_of(kSpace), text.size());
    fields.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return fields;
}

[[noreturn]] void refuse_writing(const std::filesystem::path& path, int error) {
  throw DeviceError(path.string(), "writing", std::strerror(error), "check the folder, its permissions and free space");
}

}  // namespace

std::vector<TextRow> read_rows(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path)) {
    throw InputError(path.string(), 0, "cannot be read as a text file", "check the path and its permissions");
  }
  std::vector<TextRow> rows;
  std::string text;
  for (int line = 1; std::getline(file, text); ++line) {
    std::string_view content = text;
    if (line == 1 && content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
    content = trimmed(content.substr(0, content.find('#')));
    if (content.empty()) continue;
    const bool commas = content.find(',') != std::string_view::npos;
    rows.push_back({line, commas, commas ? split_at_commas(content) : split_at_space(content)});
  }
  if (file.bad()) throw InputError(path.string(), 0, "could not be read to its end", "check the disk");
  return rows;
}

double finite_number(const std::filesystem::path& path, const TextRow& row, std::size_t column) {
  std::string_view text = row.fields.at(column);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw InputError(path.string(), row.line,
                     fmt::format("column {} is not a finite number: '{}'", column + 1, row.fields[column]),
                     "correct or remove the line");
  }
  return value;
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  std::filesystem::path part = path;
  part += ".part";
  errno = 0;
  std::ofstream file(part, std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file) refuse_writing(path, errno);
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) refuse_writing(path, error.value());
}

}  // namespace alidade
