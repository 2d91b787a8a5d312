// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace alidade {

/// A row of numbers or words in a text file, and where it stands.
struct TextRow {
  int line = 0;         ///< from 1
  bool commas = false;  ///< fields were parted by commas
  std::vector<std::string> fields;
};

/// The rows of a text file without blank lines and comments ('#' to the end of the line). Fields are parted by commas
/// where the row has one, else by white space. Throws InputError where the file cannot be read.
std::vector<TextRow> read_rows(const std::filesystem::path& path);

/// The number in field `column` (from 0) of `row`. Throws InputError naming path, line and column where it is not a
/// finite number.
double finite_number(const std::filesystem::path& path, const TextRow& row, std::size_t column);

/// Writes `text` under the name "`path`.part" and renames it when complete, so that no half-written file bears the
/// right name. Throws DeviceError where the file system refuses.
void write_text(const std::filesystem::path& path, std::string_view text);

}  // namespace alidade
