// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace alidade {

/// Where the columns of a file of readings stand, from 0; -1: not there.
struct ReadingColumns {
  int count = 0;
  int t_ns = -1, t_s = -1;
  int detector = -1, marker = -1;
  int value_rad = -1, value_px = -1;
  std::array<int, 4> plane{-1, -1, -1, -1};  ///< nx, ny, nz, d_m
  int sigma_rad = -1, sigma_px = -1;
};

/// The columns by the names in the file's first line; names that are not known are passed over. Throws InputError for a
/// column that is missing or there twice.
ReadingColumns find_reading_columns(const std::string& path, int line, std::string_view header);

/// Cuts `text` at its commas into `cells`, without blanks around them; their number goes on counting beyond what
/// `cells` holds. No allocation.
int split_cells(std::string_view text, std::vector<std::string_view>& cells);

}  // namespace alidade
