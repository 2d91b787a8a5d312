// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace alidade {

/// A ratio with the interval that holds it with 95 % probability.
struct Ratio {
  double value = 0.0;
  double low = 0.0, high = 0.0;
};

/// Root mean square over root mean square of two estimators in the same runs: each span holds one mean square error per
/// run. The interval is by bootstrap over the runs (1000 resamples, deterministic). Throws std::invalid_argument where
/// the lengths differ or are zero.
Ratio ratio_of_rms(std::span<const double> mean_squares, std::span<const double> reference);

/// The root of the mean of all mean squares.
double pooled_rms(std::span<const double> mean_squares);

}  // namespace alidade
