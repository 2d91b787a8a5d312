// SPDX-License-Identifier: Apache-2.0
#include "io/table.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/nearest_name.h"
#include "io/text_lines.h"

namespace alidade {
namespace {

// The cell that `rest` starts with; takes it and its comma off. Empty where a quote does not end.
std::optional<std::string> take_cell(std::string_view& rest) {
  rest = rest.substr(std::min(rest.find_first_not_of(" \t"), rest.size()));
  if (!rest.starts_with('"')) {
    const std::string cell(trim(rest.substr(0, rest.find(','))));
    rest.remove_prefix(std::min(rest.find(','), rest.size()));
    return cell;
  }
  std::string cell;
  for (std::size_t i = 1; i < rest.size(); ++i) {
    if (rest[i] != '"') {
      cell += rest[i];
    } else if (i + 1 < rest.size() && rest[i + 1] == '"') {
      cell += rest[i++];
    } else {
      rest = trim(rest.substr(i + 1));
      if (!rest.empty() && rest.front() != ',') return std::nullopt;
      return cell;
    }
  }
  return std::nullopt;
}

std::vector<std::string> split_cells(const std::filesystem::path& path, const TextLine& line) {
  std::vector<std::string> cells;
  std::string_view rest = line.text;
  while (true) {
    auto cell = take_cell(rest);
    if (!cell) throw InputError(path, line.number, "a quoted cell does not end at its quote", "double quotes in cells");
    cells.push_back(std::move(*cell));
    if (rest.empty()) return cells;
    rest.remove_prefix(1);
  }
}

void check_header(const std::filesystem::path& path, int line, const std::vector<std::string>& columns) {
  for (auto name = columns.begin(); name != columns.end(); ++name) {
    if (name->empty()) {
      throw InputError(path, line, fmt::format("column {} has no name", name - columns.begin() + 1), "");
    }
    if (std::find(columns.begin(), name, *name) != name) {
      throw InputError(path, line, fmt::format("two columns are named '{}'", *name), "");
    }
  }
}

std::string quoted(const std::string& text) {
  const bool plain = text.find_first_of(",\"\n\r#") == std::string::npos && trim(text) == text;
  if (plain) return text;
  std::string cell = "\"";
  for (const char c : text) cell.append(c == '"' ? 2 : 1, c == '\n' || c == '\r' ? ' ' : c);
  return cell + '"';
}

}  // namespace

Table::Table(std::filesystem::path path, std::vector<std::string> columns, std::vector<Row> rows)
    : path_(std::move(path)), columns_(std::move(columns)), rows_(std::move(rows)) {}

bool Table::has_column(std::string_view name) const {
  return std::find(columns_.begin(), columns_.end(), name) != columns_.end();
}

std::size_t Table::column(std::string_view name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  if (found != columns_.end()) return static_cast<std::size_t>(found - columns_.begin());
  const std::vector<std::string_view> known(columns_.begin(), columns_.end());
  throw InputError(path_, 0, fmt::format("has no column '{}'", name), suggest_name(name, known));
}

double Table::number(std::size_t row, std::size_t column) const {
  try {
    return parse_number(path_, rows_.at(row).line, text(row, column));
  } catch (const InputError&) {
    const std::string& cell = text(row, column);
    throw error(row, fmt::format("column '{}': '{}' is not a finite number", columns_[column], cell),
                "correct it or leave the row out");
  }
}

std::int64_t Table::integer(std::size_t row, std::size_t column) const {
  try {
    return parse_integer(path_, rows_.at(row).line, text(row, column));
  } catch (const InputError&) {
    const std::string& cell = text(row, column);
    throw error(row, fmt::format("column '{}': '{}' is not a whole number", columns_[column], cell),
                "correct it or leave the row out");
  }
}

InputError Table::error(std::size_t row, const std::string& what, const std::string& remedy) const {
  return InputError(path_, rows_.at(row).line, what, remedy);
}

Table read_table(const std::filesystem::path& path) {
  const std::vector<TextLine> lines = read_lines(path);
  if (lines.empty()) throw InputError(path, 0, "is empty", "its first line must name the columns");
  std::vector<std::string> columns = split_cells(path, lines.front());
  check_header(path, lines.front().number, columns);
  std::vector<Table::Row> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    rows.push_back({lines[i].number, split_cells(path, lines[i])});
    if (rows.back().fields.size() != columns.size()) {
      throw InputError(path, lines[i].number,
                       fmt::format("has {} cells, the header names {}", rows.back().fields.size(), columns.size()),
                       "correct the row or leave it out");
    }
  }
  return Table(path, std::move(columns), std::move(rows));
}

TableWriter::TableWriter(const std::filesystem::path& path, std::span<const std::string_view> columns)
    : file_(path), width_(columns.size()) {
  file_.write(fmt::format("{}\n", fmt::join(columns, ",")));
}

void TableWriter::write_row(std::span<const TableCell> cells) {
  if (cells.size() != width_) throw std::invalid_argument("TableWriter::write_row: as many cells as columns");
  std::string line;
  for (const TableCell& cell : cells) {
    if (!line.empty() || &cell != cells.data()) line += ',';
    if (const auto* text = std::get_if<std::string>(&cell)) line += quoted(*text);
    if (const auto* number = std::get_if<double>(&cell)) line += fmt::format("{}", *number);
    if (const auto* integer = std::get_if<std::int64_t>(&cell)) line += fmt::format("{}", *integer);
  }
  file_.write(line + '\n');
}

}  // namespace alidade
