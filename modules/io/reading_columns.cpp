// SPDX-License-Identifier: Apache-2.0
#include "io/reading_columns.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/errors.h"
#include "core/nearest_name.h"
#include "io/text_lines.h"

namespace alidade {
namespace {

// Finds columns by name.
class Header {
 public:
  Header(const std::string& path, int line, std::string_view text) : path_(path), line_(line), names_(16) {
    const int count = split_cells(text, names_);
    names_.resize(static_cast<std::size_t>(count));
    if (count > 16) split_cells(text, names_);
    for (auto name = names_.begin(); name != names_.end(); ++name) {
      if (!name->empty() && std::find(names_.begin(), name, *name) != name) {
        throw InputError(path_, line_, fmt::format("two columns are named '{}'", *name), "");
      }
    }
  }

  int find(std::string_view name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
  }

  int require(std::string_view name) const {
    const int column = find(name);
    if (column >= 0) return column;
    throw InputError(path_, line_, fmt::format("has no column '{}'", name), suggest_name(name, names_));
  }

  int count() const { return static_cast<int>(names_.size()); }
  [[noreturn]] void refuse(const char* what, const char* remedy) const { throw InputError(path_, line_, what, remedy); }

 private:
  std::string path_;
  int line_;
  std::vector<std::string_view> names_;
};

}  // namespace

ReadingColumns find_reading_columns(const std::string& path, int line, std::string_view text) {
  const Header header(path, line, text);
  ReadingColumns columns;
  columns.count = header.count();
  columns.t_ns = header.find("t_ns");
  if (columns.t_ns < 0) columns.t_s = header.require("t_s");
  columns.detector = header.require("detector");
  columns.marker = header.require("marker");
  columns.value_rad = header.find("angle_raw_rad");
  if (columns.value_rad < 0) columns.value_rad = header.find("value_rad");
  columns.value_px = header.find("value_px");
  constexpr std::array<std::string_view, 4> kPlane{"nx", "ny", "nz", "d_m"};
  const bool any = std::any_of(kPlane.begin(), kPlane.end(), [&](auto name) { return header.find(name) >= 0; });
  if (any && columns.value_rad < 0 && columns.value_px < 0) {
    for (std::size_t i = 0; i < 4; ++i) columns.plane[i] = header.require(kPlane[i]);
  }
  if (!any && columns.value_rad < 0 && columns.value_px < 0) {
    header.refuse("has no column with readings", "'angle_raw_rad', 'value_px' or a plane 'nx,ny,nz,d_m' is wanted");
  }
  columns.sigma_rad = header.find("sigma_rad");
  columns.sigma_px = header.find("sigma_px");
  return columns;
}

int split_cells(std::string_view text, std::vector<std::string_view>& cells) {
  std::size_t count = 0;
  while (true) {
    const std::size_t comma = text.find(',');
    if (count < cells.size()) cells[count] = trim(text.substr(0, comma));
    ++count;
    if (comma == std::string_view::npos) return static_cast<int>(count);
    text.remove_prefix(comma + 1);
  }
}

}  // namespace alidade
