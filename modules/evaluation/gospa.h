// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

namespace alidade {

struct SetMetricOptions {
  double cutoff_m = 5.0;  ///< an estimate farther from a target is none of it
  double order = 2.0;     ///< 2: errors are squared, as in an RMS
};

/// How far a set of estimated positions is from the true set, and why. The total is (localisation + missed + false)
/// to the power 1 / order; the parts are in m^order and can be summed over times.
struct Gospa {
  double total_m = 0.0;
  double localisation = 0.0;  ///< sum of the paired distances to the power `order`
  double missed_cost = 0.0;   ///< cutoff^order / 2 for each target without an estimate
  double false_cost = 0.0;    ///< cutoff^order / 2 for each estimate without a target
  std::size_t pairs = 0, missed = 0, false_ones = 0;
};

/// Generalised optimal sub-pattern assignment with alpha = 2: positions in m, in any frame that both share. Throws
/// std::invalid_argument unless cutoff_m > 0, order >= 1, and for positions that are not finite.
/// Source: Rahmathullah, García-Fernández, Svensson, Generalized optimal sub-pattern assignment metric, FUSION 2017,
/// proposition 1.
Gospa gospa(std::span<const Eigen::Vector3d> truth, std::span<const Eigen::Vector3d> estimates,
            const SetMetricOptions& options = {});

/// Optimal sub-pattern assignment, m: the mean over the greater set, each one without a partner counting as the cutoff.
/// 0 for two empty sets. Throws as gospa does.
/// Source: Schuhmacher, Vo, Vo, A consistent metric for performance evaluation of multi-object filters, 2008, eq. 3.
double ospa(std::span<const Eigen::Vector3d> truth, std::span<const Eigen::Vector3d> estimates,
            const SetMetricOptions& options = {});

}  // namespace alidade
