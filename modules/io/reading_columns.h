// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "io/table_stream.h"

namespace alidade {

/// Where the columns of a file of readings stand, from 0; -1: not there.
struct ReadingColumns {
  int t_ns = -1, t_s = -1;
  int detector = -1, marker = -1;
  int value_rad = -1, value_px = -1;
  std::array<int, 4> plane{-1, -1, -1, -1};  ///< nx, ny, nz, d_m
  int sigma_rad = -1, sigma_px = -1;
};

/// The columns by their names; names that are not known are passed over. Throws InputError for a column that is
/// missing.
ReadingColumns find_reading_columns(const TableStream& table);

}  // namespace alidade
