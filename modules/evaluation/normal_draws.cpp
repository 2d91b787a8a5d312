// SPDX-License-Identifier: Apache-2.0
#include "evaluation/normal_draws.h"

#include <random>
#include <stdexcept>

#include <Eigen/Cholesky>

namespace alidade {

Eigen::MatrixXd matched_normal_draws(Eigen::Index runs, Eigen::Index dimensions, std::uint64_t seed) {
  if (dimensions < 1 || runs <= dimensions + 1) {
    throw std::invalid_argument("matched_normal_draws: runs must be > dimensions + 1, and dimensions >= 1");
  }
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd draws(runs, dimensions);
  for (Eigen::Index i = 0; i < runs; ++i) {
    for (Eigen::Index j = 0; j < dimensions; ++j) draws(i, j) = normal(random);
  }
  draws.rowwise() -= draws.colwise().mean().eval();
  const Eigen::MatrixXd covariance = draws.transpose() * draws / static_cast<double>(runs);
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  return llt.matrixL().solve(draws.transpose()).transpose();
}

}  // namespace alidade
