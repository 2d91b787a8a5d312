// SPDX-License-Identifier: Apache-2.0
#include "io/reading_columns.h"

#include <algorithm>
#include <string_view>

namespace alidade {

ReadingColumns find_reading_columns(const TableStream& table) {
  ReadingColumns columns;
  columns.t_ns = table.find("t_ns");
  if (columns.t_ns < 0) columns.t_s = table.require("t_s");
  columns.detector = table.require("detector");
  columns.marker = table.require("marker");
  columns.value_rad = table.find("angle_raw_rad");
  if (columns.value_rad < 0) columns.value_rad = table.find("value_rad");
  columns.value_px = table.find("value_px");
  constexpr std::array<std::string_view, 4> kPlane{"nx", "ny", "nz", "d_m"};
  const bool any = std::any_of(kPlane.begin(), kPlane.end(), [&](auto name) { return table.find(name) >= 0; });
  if (any && columns.value_rad < 0 && columns.value_px < 0) {
    for (std::size_t i = 0; i < 4; ++i) columns.plane[i] = table.require(kPlane[i]);
  }
  if (!any && columns.value_rad < 0 && columns.value_px < 0) {
    table.refuse_header("has no column with readings",
                        "'angle_raw_rad', 'value_px' or a plane 'nx,ny,nz,d_m' is wanted");
  }
  columns.sigma_rad = table.find("sigma_rad");
  columns.sigma_px = table.find("sigma_px");
  return columns;
}

}  // namespace alidade
