// SPDX-License-Identifier: Apache-2.0
#include "evaluation/consistency.h"

#include <stdexcept>

#include <Eigen/Cholesky>

#include "evaluation/chi_square.h"

namespace alidade {
namespace {

std::optional<double> nees_of(const StampedPose& estimate, const Eigen::Isometry3d& T_truth) {
  if (!estimate.covariance) return std::nullopt;
  // Metres and radians may differ by orders of magnitude: judge singularity on the correlations.
  const Matrix6d& P = *estimate.covariance;
  if (!(P.diagonal().minCoeff() > 0)) return std::nullopt;
  const Vector6d scale = P.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Matrix6d> correlations(scale.asDiagonal() * P * scale.asDiagonal());
  if (!(correlations.vectorD().minCoeff() > 1e-12)) return std::nullopt;
  const Vector6d xi = scale.asDiagonal() * difference(estimate.T_world_camera, T_truth);
  return xi.dot(correlations.solve(xi));
}

}  // namespace

std::optional<Consistency> consistency(const PairedTrajectories& pairs) {
  if (pairs.estimate.size() != pairs.truth.size()) throw std::invalid_argument("consistency: unequal lengths");
  constexpr double kDegrees = 6, kTail = 0.025;
  Consistency result;
  double sum = 0;
  for (std::size_t i = 0; i < pairs.truth.size(); ++i) {
    result.nees.push_back(nees_of(pairs.estimate[i], pairs.truth[i].T_world_camera));
    if (!result.nees.back()) continue;
    ++result.count;
    sum += *result.nees.back();
  }
  if (result.count == 0) return std::nullopt;
  const double degrees = kDegrees * static_cast<double>(result.count);
  result.mean_per_degree = sum / degrees;
  result.lower = chi_square_quantile(degrees, kTail) / degrees;
  result.upper = chi_square_quantile(degrees, 1.0 - kTail) / degrees;
  return result;
}

}  // namespace alidade
