// SPDX-License-Identifier: Apache-2.0
#include "evaluation/target_detection.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace alidade {
namespace {

struct Pairing {
  std::size_t estimate, truth;
  double distance_m;
};

// Sums over one run, of which all statistics are made.
struct RunSums {
  double count = 0.0, sum = 0.0, squares = 0.0;
  bool all_found = false, right_number = false;
};

struct Values {
  double mean, sd, all_found, right_number;
};

RunSums sums_of(const DetectionOutcome& run) {
  RunSums sums;
  for (const auto& distance : run.distance_m) {
    if (!distance) continue;
    sums.count += 1.0;
    sums.sum += *distance;
    sums.squares += *distance * *distance;
  }
  sums.all_found = run.found == run.distance_m.size();
  sums.right_number = run.estimates == run.distance_m.size();
  return sums;
}

template <typename Pick>
Values values_of(const std::vector<RunSums>& runs, Pick pick) {
  double count = 0.0, sum = 0.0, squares = 0.0, all_found = 0.0, right_number = 0.0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunSums& run = runs[pick(i)];
    count += run.count, sum += run.sum, squares += run.squares;
    all_found += run.all_found ? 1.0 : 0.0;
    right_number += run.right_number ? 1.0 : 0.0;
  }
  const double mean = count > 0.0 ? sum / count : 0.0, n = static_cast<double>(runs.size());
  const double variance = count > 0.0 ? std::max(0.0, squares / count - mean * mean) : 0.0;
  return {mean, std::sqrt(variance), all_found / n, right_number / n};
}

MeanWithError with_error(double value, const std::vector<Values>& resamples, double Values::*field) {
  double sum = 0.0, squares = 0.0;
  for (const Values& v : resamples) sum += v.*field, squares += v.*field * v.*field;
  const double n = static_cast<double>(resamples.size());
  return {value, std::sqrt(std::max(0.0, squares / n - sum / n * sum / n))};
}

}  // namespace

DetectionOutcome detect_targets(std::span<const Eigen::Vector3d> estimates, std::span<const Eigen::Vector3d> truth,
                                double radius_m) {
  if (!(radius_m > 0.0)) throw std::invalid_argument("detect_targets: radius_m must be > 0 m");
  std::vector<Pairing> pairings;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    for (std::size_t k = 0; k < truth.size(); ++k) {
      pairings.push_back({i, k, (estimates[i] - truth[k]).norm()});
      if (!std::isfinite(pairings.back().distance_m)) throw std::invalid_argument("detect_targets: not finite");
    }
  }
  std::stable_sort(pairings.begin(), pairings.end(),
                   [](const Pairing& a, const Pairing& b) { return a.distance_m < b.distance_m; });
  DetectionOutcome outcome;
  outcome.estimates = estimates.size();
  outcome.distance_m.resize(truth.size());
  std::vector<bool> is_used(estimates.size());
  for (const Pairing& p : pairings) {
    if (is_used[p.estimate] || outcome.distance_m[p.truth]) continue;
    is_used[p.estimate] = true;
    outcome.distance_m[p.truth] = p.distance_m;
    if (p.distance_m <= radius_m) ++outcome.found;
  }
  outcome.false_ones = estimates.size() - outcome.found;
  return outcome;
}

DetectionStatistics summarise(std::span<const DetectionOutcome> runs) {
  if (runs.empty()) throw std::invalid_argument("summarise: there are no runs");
  std::vector<RunSums> sums;
  DetectionStatistics statistics;
  statistics.runs = runs.size();
  for (const DetectionOutcome& run : runs) {
    sums.push_back(sums_of(run));
    statistics.false_per_run += static_cast<double>(run.false_ones) / static_cast<double>(runs.size());
  }
  constexpr int kResamples = 1000;
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::size_t> any(0, runs.size() - 1);
  std::vector<Values> resamples;
  for (int i = 0; i < kResamples; ++i) {
    resamples.push_back(values_of(sums, [&](std::size_t) { return any(random); }));
  }
  const Values values = values_of(sums, [](std::size_t i) { return i; });
  statistics.distance_mean_m = with_error(values.mean, resamples, &Values::mean);
  statistics.distance_sd_m = with_error(values.sd, resamples, &Values::sd);
  statistics.all_found = with_error(values.all_found, resamples, &Values::all_found);
  statistics.right_number = with_error(values.right_number, resamples, &Values::right_number);
  return statistics;
}

}  // namespace alidade
