// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace alidade {

/// Normal equations H x = g of a chain of knots, each of which is tied to its neighbours, and of a border of parameters
/// that all may depend on: block-tridiagonal with a border. Solved in time proportional to the number of knots.
struct BorderedSystem {
  static constexpr int kBlock = 12;
  using Block = Eigen::Matrix<double, kBlock, kBlock>;
  using BlockVector = Eigen::Matrix<double, kBlock, 1>;

  BorderedSystem(std::size_t knots, Eigen::Index border);

  std::vector<Block> diagonal;          ///< one per knot
  std::vector<Block> coupling;          ///< rows of knot i + 1, columns of knot i
  std::vector<Eigen::MatrixXd> border;  ///< rows of the border, columns of knot i
  Eigen::MatrixXd corner;
  std::vector<BlockVector> gradient;
  Eigen::VectorXd border_gradient;
};

struct BorderedSolution {
  std::vector<BorderedSystem::BlockVector> knots;
  Eigen::VectorXd border;
  Eigen::MatrixXd border_covariance;  ///< inverse of the corner's Schur complement
};

/// The solution with `damping` times its diagonal added (Levenberg–Marquardt), 0: none. Empty where the system is not
/// positive definite.
std::optional<BorderedSolution> solve(BorderedSystem system, double damping);

}  // namespace alidade
