// SPDX-License-Identifier: Apache-2.0
#include "evaluation/running_statistics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {

void RunningStatistics::add(double value) {
  if (!std::isfinite(value)) throw std::invalid_argument(fmt::format("a value must be finite, got {}", value));
  ++count_;
  sum_ += value;
  sum_of_squares_ += value * value;
  largest_ = std::max(largest_, std::abs(value));
  const double bin = kBinsPerDecade * (std::log10(std::abs(value)) - kLowest);  // -infinity for 0
  ++bins_[static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bins_.size() - 1)))];
}

double RunningStatistics::mean() const {
  return count_ > 0 ? sum_ / static_cast<double>(count_) : 0.0;
}

double RunningStatistics::rms() const {
  return count_ > 0 ? std::sqrt(sum_of_squares_ / static_cast<double>(count_)) : 0.0;
}

double RunningStatistics::median_magnitude() const {
  if (count_ == 0 || largest_ == 0.0) return 0.0;
  std::int64_t below = 0;
  std::size_t bin = 0;
  while (below + bins_[bin] < (count_ + 1) / 2) below += bins_[bin++];
  const double centre = std::pow(10.0, kLowest + (static_cast<double>(bin) + 0.5) / kBinsPerDecade);
  return std::min(centre, largest_);
}

}  // namespace alidade
