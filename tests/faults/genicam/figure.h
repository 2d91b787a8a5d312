// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace alidade::test {

/// Something measured, and what was asked of it.
struct Figure {
  std::string section;  ///< of the suite: "kill"
  std::string name;     ///< "slowest event after a kill"
  double value = 0;
  std::string unit;  ///< "ms"; empty for a count
  std::optional<double> at_least{}, at_most{};
  std::string detail{};  ///< what else is worth telling; may be empty

  bool is_met() const { return (!at_least || value >= *at_least) && (!at_most || value <= *at_most); }
};

using Figures = std::vector<Figure>;

/// One JSON object on one line: section, name, value, unit, at_least and at_most where there are bounds, is_met, and
/// detail where there is any.
std::string to_json(const Figure& figure);

/// The same for people.
std::string to_text(const Figure& figure);

/// The value below which the `share` of `values` lies; 0 of none.
double quantile(std::vector<double> values, double share);

}  // namespace alidade::test
