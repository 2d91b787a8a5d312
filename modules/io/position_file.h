// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "geometry/positions.h"

namespace alidade {

/// Reads where a point was over time: a CSV file with the columns `t_ns` or `t_s`, `x_m`, `y_m`, `z_m` (others are
/// passed over), or anything that read_trajectory reads, its positions alone. Throws InputError with the line for a
/// missing column, what is no finite number and a time that goes back, and for a file without a position.
std::vector<TimedPosition> read_positions(const std::filesystem::path& path);

}  // namespace alidade
