// SPDX-License-Identifier: Apache-2.0
#include "io/position_file.h"

#include <fstream>
#include <string>

#include "core/errors.h"
#include "io/table.h"
#include "io/trajectory_file.h"

namespace alidade {
namespace {

// A header that names columns as ours do; EuRoC's data.csv begins with '#'.
bool is_table(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) return false;
  std::ifstream file(path);
  std::string first;
  std::getline(file, first);
  return !first.starts_with('#') && (path.extension() == ".csv" || first.find("x_m") != std::string::npos);
}

Timestamp time_of(const Table& table, std::size_t row) {
  if (table.has_column("t_ns")) {
    return Timestamp(std::chrono::nanoseconds(table.integer(row, table.column("t_ns"))));
  }
  const std::size_t column = table.column("t_s");
  table.number(row, column);  // says what is wrong with it
  const auto time = parse_seconds(table.text(row, column));
  if (!time) throw table.error(row, "the time does not fit", "times are seconds, or t_ns");
  return *time;
}

}  // namespace

std::vector<TimedPosition> read_positions(const std::filesystem::path& path) {
  std::vector<TimedPosition> positions;
  if (!is_table(path)) {
    for (const StampedPose& pose : read_trajectory(path).poses) {
      positions.push_back({pose.time, pose.T_world_camera.translation()});
    }
    return positions;
  }
  const Table table = read_table(path);
  const std::size_t x = table.column("x_m"), y = table.column("y_m"), z = table.column("z_m");
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Timestamp time = time_of(table, row);
    if (!positions.empty() && time < positions.back().time) {
      throw table.error(row, "time goes back", "sort the positions by time");
    }
    positions.push_back({time, {table.number(row, x), table.number(row, y), table.number(row, z)}});
  }
  if (positions.empty())
    throw InputError(path, 0, "holds no position", "columns t_s, x_m, y_m, z_m and rows are wanted");
  return positions;
}

}  // namespace alidade
