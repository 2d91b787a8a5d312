// SPDX-License-Identifier: Apache-2.0
#include "io/target_file.h"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "core/errors.h"
#include "io/table_stream.h"

namespace alidade {
namespace {

constexpr std::array<std::string_view, 6> kAxes{"x", "y", "z", "vx", "vy", "vz"};

std::vector<std::string> covariance_columns() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    for (std::size_t j = i; j < kAxes.size(); ++j) names.push_back(fmt::format("c_{}_{}", kAxes[i], kAxes[j]));
  }
  return names;
}

std::vector<std::string> all_columns() {
  std::vector<std::string> names{"t_ns",   "target", "state",  "x_m",       "y_m",           "z_m",
                                 "vx_m_s", "vy_m_s", "vz_m_s", "sightings", "temperature_k", "temperature_sigma_k"};
  for (const std::string& name : covariance_columns()) names.push_back(name);
  return names;
}

TableWriter open_table(const std::filesystem::path& path) {
  const std::vector<std::string> names = all_columns();
  const std::vector<std::string_view> views(names.begin(), names.end());
  return {path, views};
}

TableCell cell_of(const std::optional<double>& value) {
  if (value) return *value;
  return std::string();
}

// Where the columns stand; −1: not there.
class Columns {
 public:
  explicit Columns(const TableStream& table) : table_(table) {
    t_ns_ = table.find("t_ns");
    t_s_ = t_ns_ < 0 ? table.require("t_s") : -1;
    target_ = table.require("target");
    constexpr std::array<const char*, 3> kPlace{"x_m", "y_m", "z_m"}, kPace{"vx_m_s", "vy_m_s", "vz_m_s"};
    for (std::size_t i = 0; i < 3; ++i) {
      place_[i] = table.require(kPlace[i]);
      pace_[i] = table.find(kPace[i]);
    }
    for (const std::string& name : covariance_columns()) covariance_.push_back(table.find(name));
    state_ = table.find("state");
    sightings_ = table.find("sightings");
    temperature_ = table.find("temperature_k");
    temperature_sigma_ = table.find("temperature_sigma_k");
  }

  TargetRow row() const {
    TargetRow row;
    row.time = table_.time(t_ns_, t_s_);
    row.target = table_.integer(target_);
    for (int i = 0; i < 3; ++i) {
      row.p_world[i] = table_.number(place_[static_cast<std::size_t>(i)]);
      row.v_world[i] = number(pace_[static_cast<std::size_t>(i)]).value_or(0.0);
    }
    if (table_.has(covariance_.front())) row.covariance = covariance();
    if (state_ >= 0) row.state = table_.cell(state_);
    if (table_.has(sightings_)) row.sightings = table_.integer(sightings_);
    row.temperature_k = number(temperature_);
    row.temperature_sigma_k = number(temperature_sigma_);
    return row;
  }

 private:
  std::optional<double> number(int column) const {
    if (!table_.has(column)) return std::nullopt;
    return table_.number(column);
  }

  Matrix6d covariance() const {
    Matrix6d P;
    std::size_t column = 0;
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) P(i, j) = P(j, i) = number(covariance_[column++]).value_or(0.0);
    }
    return P;
  }

  const TableStream& table_;
  int t_ns_, t_s_, target_, state_, sightings_, temperature_, temperature_sigma_;
  std::array<int, 3> place_{}, pace_{};
  std::vector<int> covariance_;
};

}  // namespace

TargetFileWriter::TargetFileWriter(const std::filesystem::path& path) : table_(open_table(path)) {}

void TargetFileWriter::write(const TargetRow& row) {
  std::vector<TableCell> cells{row.time.time_since_epoch().count(), std::int64_t{row.target}, row.state};
  for (const double x : row.p_world) cells.emplace_back(x);
  for (const double v : row.v_world) cells.emplace_back(v);
  cells.emplace_back(row.sightings);
  cells.push_back(cell_of(row.temperature_k));
  cells.push_back(cell_of(row.temperature_sigma_k));
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) {
      cells.push_back(row.covariance ? TableCell((*row.covariance)(i, j)) : TableCell(std::string()));
    }
  }
  table_.write_row(cells);
}

std::vector<TargetRow> read_target_rows(const std::filesystem::path& path) {
  TableStream table(path);
  const Columns columns(table);
  std::vector<TargetRow> rows;
  while (table.next()) rows.push_back(columns.row());
  if (rows.empty()) throw InputError(path.string(), 0, "holds no target", "is it the right file?");
  return rows;
}

}  // namespace alidade
