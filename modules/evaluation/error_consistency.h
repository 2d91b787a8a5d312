// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace alidade {

/// Whether errors are as large as their covariances say, over runs of which each gives a few errors of its own.
struct ErrorConsistency {
  std::size_t count = 0;            ///< errors
  double mean_per_degree = 0.0;     ///< of the normalised errors squared (NEES); 1 where they are
  double lower = 0.0, upper = 0.0;  ///< 95 % bounds of the mean, were all errors independent
};

/// Sums normalised errors squared, eᵀ P⁻¹ e.
class ErrorConsistencyTally {
 public:
  /// Of any dimension, the same for all. Throws std::invalid_argument for sizes that differ and for a covariance that
  /// is not positive definite.
  void add(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance);

  /// Of a normalised error squared that is known already.
  void add(double nees, int dimension);

  ErrorConsistency result() const;  ///< all 0 where nothing was added

 private:
  std::size_t count_ = 0;
  double sum_ = 0.0, degrees_ = 0.0;
};

}  // namespace alidade
