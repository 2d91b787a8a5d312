// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace alidade {

/// Standard normal draws, one of `dimensions` per row, whose mean is exactly 0 and whose covariance over the runs is
/// exactly I: what a linear estimator makes of them has exactly its covariance, so that a Monte Carlo check of some
/// hundred runs tells a per cent. Throws std::invalid_argument unless runs > dimensions + 1 and dimensions >= 1.
/// Source: moment matching; Barraquand, Numerical valuation of high dimensional multivariate European securities,
/// Management Science 41(12), 1995 (quadratic resampling).
Eigen::MatrixXd matched_normal_draws(Eigen::Index runs, Eigen::Index dimensions, std::uint64_t seed);

}  // namespace alidade
