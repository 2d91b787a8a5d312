// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace alidade {

/// A mark on an axis.
struct Tick {
  double value = 0;
  std::string text;
};

/// Round values (1, 2 or 5 times a power of ten) within [low, high], about `wanted` of them, all printed with the same
/// number of digits, enough to tell them apart. Throws std::invalid_argument unless low < high and both are finite.
std::vector<Tick> linear_ticks(double low, double high, int wanted);

/// Powers of ten within [low, high], thinned to at most `most`; where there are fewer than two, also 2 and 5 times
/// them, and where these are too few, linear_ticks. Throws std::invalid_argument unless 0 < low < high.
std::vector<Tick> logarithmic_ticks(double low, double high, int most);

}  // namespace alidade
