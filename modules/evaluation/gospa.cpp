// SPDX-License-Identifier: Apache-2.0
#include "evaluation/gospa.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "estimation/assignment.h"

namespace alidade {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

void require_sense(std::span<const Vector3d> truth, std::span<const Vector3d> estimates,
                   const SetMetricOptions& options) {
  if (!(options.cutoff_m > 0.0)) throw std::invalid_argument("gospa: cutoff_m must be > 0 m");
  if (!(options.order >= 1.0)) throw std::invalid_argument("gospa: order must be >= 1");
  const auto is_finite = [](const Vector3d& p) { return p.allFinite(); };
  if (!std::all_of(truth.begin(), truth.end(), is_finite) ||
      !std::all_of(estimates.begin(), estimates.end(), is_finite)) {
    throw std::invalid_argument("gospa: a position is not finite");
  }
}

// What it saves to pair a target with an estimate: it is then neither missed nor false.
Eigen::MatrixXd savings(std::span<const Vector3d> truth, std::span<const Vector3d> estimates,
                        const SetMetricOptions& options) {
  Eigen::MatrixXd saved(truth.size(), estimates.size());
  for (Index i = 0; i < saved.rows(); ++i) {
    for (Index j = 0; j < saved.cols(); ++j) {
      const double distance = (truth[static_cast<std::size_t>(i)] - estimates[static_cast<std::size_t>(j)]).norm();
      saved(i, j) = std::pow(options.cutoff_m, options.order) - std::pow(distance, options.order);
    }
  }
  return saved;
}

}  // namespace

Gospa gospa(std::span<const Vector3d> truth, std::span<const Vector3d> estimates, const SetMetricOptions& options) {
  require_sense(truth, estimates, options);
  const double unpaired = std::pow(options.cutoff_m, options.order);
  const Eigen::MatrixXd saved = savings(truth, estimates, options);
  Gospa result;
  const auto estimate_of = best_assignment(saved);
  for (std::size_t i = 0; i < estimate_of.size(); ++i) {
    if (!estimate_of[i]) continue;
    ++result.pairs;
    result.localisation += unpaired - saved(static_cast<Index>(i), *estimate_of[i]);
  }
  result.missed = truth.size() - result.pairs;
  result.false_ones = estimates.size() - result.pairs;
  result.missed_cost = 0.5 * unpaired * static_cast<double>(result.missed);
  result.false_cost = 0.5 * unpaired * static_cast<double>(result.false_ones);
  result.total_m = std::pow(result.localisation + result.missed_cost + result.false_cost, 1.0 / options.order);
  return result;
}

double ospa(std::span<const Vector3d> truth, std::span<const Vector3d> estimates, const SetMetricOptions& options) {
  const Gospa parts = gospa(truth, estimates, options);
  const std::size_t most = std::max(truth.size(), estimates.size());
  if (most == 0) return 0.0;
  const double alone = std::pow(options.cutoff_m, options.order) * static_cast<double>(most - parts.pairs);
  return std::pow((parts.localisation + alone) / static_cast<double>(most), 1.0 / options.order);
}

}  // namespace alidade
