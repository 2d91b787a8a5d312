// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace alidade {

/// What a method found of the objects that were there.
struct DetectionOutcome {
  /// Of each true position, how far its estimate is (m), also beyond the radius; empty where none was left for it.
  std::vector<std::optional<double>> distance_m;
  std::size_t found = 0;       ///< true positions whose estimate is within the radius
  std::size_t false_ones = 0;  ///< estimates within the radius of none, or of one that another is nearer to
  std::size_t estimates = 0;
};

/// Pairs estimates and true positions (m) one to one, nearest pair first, and counts those within `radius_m`. Throws
/// std::invalid_argument unless radius_m > 0 and all is finite.
DetectionOutcome detect_targets(std::span<const Eigen::Vector3d> estimates, std::span<const Eigen::Vector3d> truth,
                                double radius_m);

/// A mean with its standard error over runs.
struct MeanWithError {
  double value = 0.0, standard_error = 0.0;
};

/// What many runs come to. The errors are by bootstrap over whole runs (1000 resamples, deterministic), since the
/// objects of one run err alike.
struct DetectionStatistics {
  std::size_t runs = 0;
  MeanWithError distance_mean_m, distance_sd_m;  ///< d: of all paired estimates, found or not
  MeanWithError all_found;                       ///< Pr_m: share of runs in which every object was found
  MeanWithError right_number;                    ///< share of runs with as many estimates as objects
  double false_per_run = 0.0;
};

/// Throws std::invalid_argument without runs.
/// Source: UAV paper, "Their experiment" (d, Pr_m).
DetectionStatistics summarise(std::span<const DetectionOutcome> runs);

}  // namespace alidade
