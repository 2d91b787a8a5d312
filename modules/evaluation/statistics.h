// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace alidade {

/// What a list of errors comes to, in the unit of the errors. All zero for an empty list.
struct Statistics {
  std::size_t count = 0;
  double rmse = 0;
  double mean = 0;
  double median = 0;
  double std = 0;  ///< of the population: divided by count
  double max = 0;
  double min = 0;
};

Statistics summarise(const std::vector<double>& values);

/// Errors in order of time, and what they come to.
struct ErrorSeries {
  std::vector<double> values;
  Statistics statistics;
};

ErrorSeries with_statistics(std::vector<double> values);

}  // namespace alidade
