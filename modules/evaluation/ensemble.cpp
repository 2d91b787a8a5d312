// SPDX-License-Identifier: Apache-2.0
#include "evaluation/ensemble.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

namespace alidade {
namespace {

// Of blocks whose lengths differ by one at most; over the mean length, so that they pool to the mean of all squares.
std::vector<double> block_squares(std::span<const double> errors, std::size_t blocks) {
  std::vector<double> sums(blocks, 0.0);
  for (std::size_t i = 0; i < errors.size(); ++i) sums[i * blocks / errors.size()] += errors[i] * errors[i];
  for (double& sum : sums) sum *= static_cast<double>(blocks) / static_cast<double>(errors.size());
  return sums;
}

}  // namespace

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

Ratio ratio_of_rms_in_blocks(std::span<const double> errors, std::span<const double> reference, std::size_t block) {
  if (errors.size() != reference.size() || reference.empty() || block == 0) {
    throw std::invalid_argument("ratio_of_rms_in_blocks: both estimators need the same frames, and blocks of one");
  }
  const std::size_t blocks = std::max<std::size_t>(1, reference.size() / block);
  return ratio_of_rms(block_squares(errors, blocks), block_squares(reference, blocks));
}

}  // namespace alidade
