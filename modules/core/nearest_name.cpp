// SPDX-License-Identifier: Apache-2.0
#include "core/nearest_name.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace alidade {

// Optimal string alignment: three rows of the table are enough.
int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> before_last(b.size() + 1);
  std::vector<int> last(b.size() + 1);
  std::vector<int> row(b.size() + 1);
  std::iota(last.begin(), last.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    std::swap(before_last, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string_view> known) {
  std::optional<std::string> nearest;
  int fewest = 0;
  for (const std::string_view name : known) {
    const int edits = edit_distance(word, name);
    const auto allowed = std::max<std::size_t>(1, std::max(word.size(), name.size()) / 3);
    if (static_cast<std::size_t>(edits) > allowed || (nearest && edits >= fewest)) continue;
    nearest = std::string(name);
    fewest = edits;
  }
  return nearest;
}

std::string suggest_name(std::string_view word, std::span<const std::string_view> known) {
  if (const auto nearest = nearest_name(word, known)) return fmt::format("did you mean '{}'?", *nearest);
  if (known.empty()) return "";
  return fmt::format("known are: {}", fmt::join(known, ", "));
}

}  // namespace alidade
