// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

namespace alidade {

/// By what a linear detector tells a marker from others: the rows (exposures) in which it is lit, and its colour.
struct MarkerSign {
  int id = 0;                ///< BodyMarker::id
  std::string code = "1";    ///< a row each, '1' lit and '0' dark, over and over; "1": always lit
  std::optional<int> phase;  ///< row 0 shows code[phase]; empty: unknown
  /// Its share in the channels of the line image, in their order, any scale; empty: unknown, or one channel.
  std::optional<std::array<double, 3>> colour;
};

}  // namespace alidade
