// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace alidade {

/// A row of numbers or words in a text file, and where it stands.
struct TextRow {
  int line = 0;         ///< from 1
  bool commas = false;  ///< fields were parted by commas
  std::vector<std::string> fields;
};

/// The rows of a text file without blank lines and comment lines (#). Fields are parted by commas where the row has
/// one, else by blanks. Throws InputError where the file cannot be read.
std::vector<TextRow> read_rows(const std::filesystem::path& path);

/// The number in field `column` (from 0) of `row`. Throws InputError naming path and line where it is not finite.
double finite_number(const std::filesystem::path& path, const TextRow& row, std::size_t column);

}  // namespace alidade
