// SPDX-License-Identifier: Apache-2.0
#include "evaluation/error_consistency.h"

#include <stdexcept>

#include <Eigen/Cholesky>

#include "evaluation/chi_square.h"

namespace alidade {

void ErrorConsistencyTally::add(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  if (covariance.rows() != error.size() || covariance.cols() != error.size()) {
    throw std::invalid_argument("ErrorConsistencyTally: error and covariance differ in size");
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  if (factor.info() != Eigen::Success || error.size() == 0) {
    throw std::invalid_argument("ErrorConsistencyTally: the covariance is not positive definite");
  }
  add(error.dot(factor.solve(error)), static_cast<int>(error.size()));
}

void ErrorConsistencyTally::add(double nees, int dimension) {
  ++count_;
  sum_ += nees;
  degrees_ += dimension;
}

ErrorConsistency ErrorConsistencyTally::result() const {
  if (count_ == 0) return {};
  constexpr double kTail = 0.025;
  return {count_, sum_ / degrees_, chi_square_quantile(degrees_, kTail) / degrees_,
          chi_square_quantile(degrees_, 1.0 - kTail) / degrees_};
}

}  // namespace alidade
