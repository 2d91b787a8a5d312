// SPDX-License-Identifier: Apache-2.0
#include "io/table_stream.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/nearest_name.h"
#include "io/text_lines.h"

namespace alidade {
namespace {

// Cuts `text` at its commas into `cells`, without blanks around them; their number goes on counting beyond what `cells`
// holds. No allocation.
std::size_t split_cells(std::string_view text, std::vector<std::string_view>& cells) {
  std::size_t count = 0;
  while (true) {
    const std::size_t comma = text.find(',');
    if (count < cells.size()) cells[count] = trim(text.substr(0, comma));
    ++count;
    if (comma == std::string_view::npos) return count;
    text.remove_prefix(comma + 1);
  }
}

// Decimal seconds as they are mostly written: digits, a point, at most nine digits. Else the slower parse_seconds.
std::optional<Timestamp> parse_time(std::string_view text) {
  const std::size_t point = text.find('.');
  const std::string_view whole = text.substr(0, point);
  const std::string_view fraction = point == std::string_view::npos ? "" : text.substr(point + 1);
  if (whole.empty() || whole.size() > 9 || fraction.size() > 9) return parse_seconds(text);
  std::int64_t count = 0;
  for (const std::string_view digits : {whole, fraction}) {
    for (const char c : digits) {
      if (c < '0' || c > '9') return parse_seconds(text);
      count = 10 * count + (c - '0');
    }
  }
  for (std::size_t i = fraction.size(); i < 9; ++i) count *= 10;
  return Timestamp(std::chrono::nanoseconds(count));
}

template <typename Number>
std::optional<Number> parse(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

TableStream::TableStream(const std::filesystem::path& path, std::stop_token stop) : stream_(path, std::move(stop)) {
  auto first = stream_.next();
  if (!first) throw InputError(stream_.name(), 0, "is empty", "its first line must name the columns");
  if (first->text.starts_with("\xEF\xBB\xBF")) first->text.remove_prefix(3);
  header_ = first->text;
  header_line_ = first->number;
  names_.resize(split_cells(header_, names_));
  split_cells(header_, names_);
  cells_.resize(names_.size());
  for (auto name = names_.begin(); name != names_.end(); ++name) {
    if (!name->empty() && std::find(names_.begin(), name, *name) != name) {
      refuse_header(fmt::format("two columns are named '{}'", *name));
    }
  }
}

int TableStream::find(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
}

int TableStream::require(std::string_view name) const {
  const int column = find(name);
  if (column < 0) refuse_header(fmt::format("has no column '{}'", name), suggest_name(name, names_));
  return column;
}

bool TableStream::next() {
  const auto row = stream_.next();
  if (!row) return false;
  line_ = row->number;
  const std::size_t found = split_cells(row->text, cells_);
  if (found == cells_.size()) return true;
  if (!row->has_end) refuse("the last line is cut off", "was the recording broken off? remove the line");
  refuse(fmt::format("has {} cells, the header names {}", found, cells_.size()), "correct the row or leave it out");
}

double TableStream::number(int column) const {
  const auto value = parse<double>(cell(column));
  if (!value || !std::isfinite(*value)) refuse_cell(column, "a finite number");
  return *value;
}

int TableStream::integer(int column) const {
  const auto value = parse<int>(cell(column));
  if (!value) refuse_cell(column, "a whole number");
  return *value;
}

Timestamp TableStream::time(int column_ns, int column_s) const {
  std::optional<Timestamp> t;
  if (column_ns >= 0) {
    if (const auto ns = parse<std::int64_t>(cell(column_ns))) t = Timestamp(std::chrono::nanoseconds(*ns));
  } else {
    t = parse_time(cell(column_s));
  }
  if (!t) refuse_cell(column_ns >= 0 ? column_ns : column_s, "a time");
  return *t;
}

void TableStream::refuse(const std::string& what, const std::string& remedy) const {
  throw InputError(stream_.name(), line_, what, remedy);
}

void TableStream::refuse_cell(int column, const char* wanted) const {
  refuse(fmt::format("column '{}': '{}' is not {}", names_[static_cast<std::size_t>(column)], cell(column), wanted),
         "correct it or leave the row out");
}

void TableStream::refuse_header(const std::string& what, const std::string& remedy) const {
  throw InputError(stream_.name(), header_line_, what, remedy);
}

std::string list_ids(std::span<const int> ids) {
  constexpr std::size_t kMost = 12;
  return fmt::format("known are: {}{}", fmt::join(ids.first(std::min(kMost, ids.size())), ", "),
                     ids.size() > kMost ? ", ..." : "");
}

}  // namespace alidade
