// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/genicam/figure.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace alidade::test {

std::string to_json(const Figure& figure) {
  nlohmann::ordered_json json{
      {"section", figure.section}, {"name", figure.name}, {"value", figure.value}, {"unit", figure.unit}};
  if (figure.at_least) json["at_least"] = *figure.at_least;
  if (figure.at_most) json["at_most"] = *figure.at_most;
  json["is_met"] = figure.is_met();
  if (!figure.detail.empty()) json["detail"] = figure.detail;
  return json.dump();
}

std::string to_text(const Figure& figure) {
  std::string bound;
  if (figure.at_least) bound += fmt::format(", asked >= {:g}", *figure.at_least);
  if (figure.at_most) bound += fmt::format(", asked <= {:g}", *figure.at_most);
  const std::string detail = figure.detail.empty() ? "" : fmt::format(" ({})", figure.detail);
  return fmt::format("{} {}: {}: {:.6g} {}{}{}", figure.is_met() ? "  ok" : "FAIL", figure.section, figure.name,
                     figure.value, figure.unit, bound, detail);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(std::ceil(at))];
}

}  // namespace alidade::test
