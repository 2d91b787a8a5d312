// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace alidade {

/// What a stream of values comes to, in memory that does not grow.
class RunningStatistics {
 public:
  /// Throws std::invalid_argument for a value that is not finite.
  void add(double value);

  std::int64_t count() const { return count_; }
  double mean() const;  ///< all are 0 where there is no value
  double rms() const;
  double largest_magnitude() const { return largest_; }

  /// The median of the magnitudes, to 1 % of itself between 1e-9 and 1e6.
  double median_magnitude() const;

 private:
  static constexpr int kBinsPerDecade = 120;  // a bin is 2 % wide
  static constexpr int kLowest = -9, kHighest = 6;

  std::int64_t count_ = 0;
  double sum_ = 0.0, sum_of_squares_ = 0.0, largest_ = 0.0;
  std::array<std::int64_t, kBinsPerDecade*(kHighest - kLowest)> bins_{};  // by the logarithm of the magnitude
};

}  // namespace alidade
