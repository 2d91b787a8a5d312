// SPDX-License-Identifier: Apache-2.0
#include "evaluation/statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace alidade {

Statistics summarise(const std::vector<double>& values) {
  Statistics s;
  if (values.empty()) return s;
  s.count = values.size();
  const double n = static_cast<double>(s.count);
  double sum = 0, squares = 0, deviations = 0;
  for (double v : values) sum += v, squares += v * v;
  s.mean = sum / n;
  s.rmse = std::sqrt(squares / n);
  for (double v : values) deviations += (v - s.mean) * (v - s.mean);
  s.std = std::sqrt(deviations / n);
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  s.min = sorted.front();
  s.max = sorted.back();
  s.median = 0.5 * (sorted[(s.count - 1) / 2] + sorted[s.count / 2]);
  return s;
}

ErrorSeries with_statistics(std::vector<double> values) {
  const Statistics statistics = summarise(values);
  return {std::move(values), statistics};
}

}  // namespace alidade
