// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/errors.h"
#include "io/atomic_file.h"

namespace alidade {

/// A CSV file whose first line names its columns, units included (t_ns, x_m, angle_rad).
/// Whatever is wrong with a cell is told with the file's name and line.
class Table {
 public:
  struct Row {
    int line = 0;
    std::vector<std::string> fields;  ///< as many as there are columns
  };

  Table(std::filesystem::path path, std::vector<std::string> columns, std::vector<Row> rows);

  const std::vector<std::string>& columns() const { return columns_; }
  std::size_t row_count() const { return rows_.size(); }
  bool has_column(std::string_view name) const;

  /// Index of a column. Throws InputError naming the nearest one where there is none of this name.
  std::size_t column(std::string_view name) const;

  const std::string& text(std::size_t row, std::size_t column) const { return rows_.at(row).fields.at(column); }

  /// A finite number. Throws InputError "path:line: column 'x_m': 'abc' is not a number".
  double number(std::size_t row, std::size_t column) const;
  std::int64_t integer(std::size_t row, std::size_t column) const;

  /// The error to throw for a row that is wrong for a reason of the caller's.
  InputError error(std::size_t row, const std::string& what, const std::string& remedy = "") const;

 private:
  std::filesystem::path path_;
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

/// Reads a CSV file: comma-separated, cells may be in double quotes (doubled inside), CRLF or LF, lines that start with
/// '#' and blank lines skipped. Throws InputError where it is empty, a column has no name or two have the same, or a
/// row has not as many cells as the header.
Table read_table(const std::filesystem::path& path);

/// A cell to write: numbers in the fewest digits that give the same number back.
using TableCell = std::variant<double, std::int64_t, std::string>;

/// Writes a CSV file row by row; it is there once commit returned. Throws DeviceError as AtomicFile does.
class TableWriter {
 public:
  TableWriter(const std::filesystem::path& path, std::span<const std::string_view> columns);

  /// As many cells as columns, else std::invalid_argument.
  void write_row(std::span<const TableCell> cells);
  void write_row(std::initializer_list<TableCell> cells) { write_row(std::span(cells.begin(), cells.size())); }
  void commit() { file_.commit(); }

 private:
  AtomicFile file_;
  std::size_t width_;
};

}  // namespace alidade
