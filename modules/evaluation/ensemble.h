// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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

/// The same for the errors of one long run: the interval is by bootstrap over blocks of about `block` frames in
/// succession, because neighbouring errors are alike. Throws std::invalid_argument as above and for a block of 0.
Ratio ratio_of_rms_in_blocks(std::span<const double> errors, std::span<const double> reference, std::size_t block);

/// The root of the mean of all mean squares.
double pooled_rms(std::span<const double> mean_squares);

}  // namespace alidade
