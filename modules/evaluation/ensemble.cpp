// SPDX-License-Identifier: Apache-2.0
#include "evaluation/ensemble.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

namespace alidade {

double pooled_rms(std::span<const double> mean_squares) {
  if (mean_squares.empty()) return 0.0;
  const double sum = std::accumulate(mean_squares.begin(), mean_squares.end(), 0.0);
  return std::sqrt(sum / static_cast<double>(mean_squares.size()));
}

Ratio ratio_of_rms(std::span<const double> mean_squares, std::span<const double> reference) {
  if (mean_squares.size() != reference.size() || reference.empty()) {
    throw std::invalid_argument("ratio_of_rms: both estimators need the same runs, at least one");
  }
  constexpr int kResamples = 1000;
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::size_t> pick(0, reference.size() - 1);
  std::vector<double> ratios;
  for (int i = 0; i < kResamples; ++i) {
    double above = 0.0, below = 0.0;
    for (std::size_t k = 0; k < reference.size(); ++k) {
      const std::size_t run = pick(random);
      above += mean_squares[run];
      below += reference[run];
    }
    ratios.push_back(std::sqrt(above / below));
  }
  std::sort(ratios.begin(), ratios.end());
  return {pooled_rms(mean_squares) / pooled_rms(reference), ratios[kResamples / 40],
          ratios[kResamples - kResamples / 40]};
}

}  // namespace alidade
