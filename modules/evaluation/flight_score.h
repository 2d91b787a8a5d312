// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace alidade {

/// The median length of a three-dimensional normal error over the root of its covariance's trace, where that is alike
/// in all directions: sqrt(2.366 / 3).
inline constexpr double kTheoreticalErrorPerSigma = 0.888;

/// An estimated position beside the true one.
struct PositionPair {
  Eigen::Vector3d estimate = Eigen::Vector3d::Zero();    ///< m
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();       ///< m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the estimate, m²; zero: not stated
};

/// How far estimated positions are from the true ones.
struct FlightScore {
  std::size_t count = 0;
  double rmse_m = 0.0, median_m = 0.0, greatest_m = 0.0;
  std::optional<double> aligned_rmse_m;   ///< once a similarity laid them over each other; empty: it is not determined
  std::optional<double> error_per_sigma;  ///< median of the errors over the roots of their covariances' traces
};

FlightScore score_flight(std::span<const PositionPair> pairs);

}  // namespace alidade
