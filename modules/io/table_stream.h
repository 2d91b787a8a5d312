// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"
#include "core/time.h"
#include "io/line_stream.h"

namespace alidade {

/// The rows of a CSV file of any length, or of standard input ("-", a live feed: a row is given out as soon as its line
/// is complete), in bounded memory and without allocation per row. The first line names the columns; cells are not
/// quoted. What is wrong with a row is told with its line.
class TableStream {
 public:
  /// Throws InputError for a file that cannot be opened or is empty, and for two columns of one name.
  explicit TableStream(const std::filesystem::path& path, std::stop_token stop = {});

  /// The column of this name, from 0; -1: there is none.
  int find(std::string_view name) const;

  /// The same; throws InputError where there is none, naming the nearest that is.
  int require(std::string_view name) const;

  /// Goes to the next row, waiting for it if need be; false at the end, and once a stop is requested. Throws InputError
  /// for a row that has not as many cells as the header.
  bool next();

  /// A cell of the row, without blanks around it.
  std::string_view cell(int column) const { return cells_[static_cast<std::size_t>(column)]; }

  /// Whether there is such a column and the row has something in it.
  bool has(int column) const { return column >= 0 && !cell(column).empty(); }

  /// Finite, else InputError naming column and content.
  double number(int column) const;
  int integer(int column) const;

  /// A moment from a column of nanoseconds, or, where that is -1, from one of decimal seconds.
  Timestamp time(int column_ns, int column_s) const;

  /// Throws InputError about the row, or about a cell in it that is not what is wanted: "column 'x': '1a' is not ...".
  [[noreturn]] void refuse(const std::string& what, const std::string& remedy = "") const;
  [[noreturn]] void refuse_cell(int column, const char* wanted) const;

  /// Throws InputError about the header.
  [[noreturn]] void refuse_header(const std::string& what, const std::string& remedy = "") const;

  std::int64_t bytes() const { return stream_.bytes(); }

 private:
  LineStream stream_;
  std::string header_;
  std::vector<std::string_view> names_, cells_;  // of header_, and of the row
  int header_line_ = 0, line_ = 0;
};

/// "known are: 0, 1, 2, ...", for the remedy where an id is not known.
std::string list_ids(std::span<const int> ids);

}  // namespace alidade
