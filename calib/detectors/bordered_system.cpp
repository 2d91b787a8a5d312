// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/bordered_system.h"

#include <Eigen/Cholesky>

namespace alidade {

BorderedSystem::BorderedSystem(std::size_t knots, Eigen::Index border_size)
    : diagonal(knots, Block::Zero()),
      coupling(knots == 0 ? 0 : knots - 1, Block::Zero()),
      border(knots, Eigen::MatrixXd::Zero(border_size, kBlock)),
      corner(Eigen::MatrixXd::Zero(border_size, border_size)),
      gradient(knots, BlockVector::Zero()),
      border_gradient(Eigen::VectorXd::Zero(border_size)) {}

// Eliminates the knots one after the other: what a knot leaves to the next is a Schur complement, as in a Kalman filter
// in information form. The way back gives the knots from the border.
std::optional<BorderedSolution> solve(BorderedSystem s, double damping) {
  const std::size_t n = s.diagonal.size();
  const Eigen::Index border_size = s.corner.rows();
  const bool has_border = border_size > 0;
  for (auto& block : s.diagonal) block.diagonal() *= 1.0 + damping;
  if (has_border) s.corner.diagonal() *= 1.0 + damping;
  std::vector<Eigen::LLT<BorderedSystem::Block>> factors;
  factors.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto& factor = factors.emplace_back(s.diagonal[i]);
    if (factor.info() != Eigen::Success) return std::nullopt;
    const BorderedSystem::BlockVector g = factor.solve(s.gradient[i]);
    if (has_border) {
      const Eigen::MatrixXd toward_border = factor.solve(s.border[i].transpose());  // 12 × border
      s.corner.noalias() -= s.border[i] * toward_border;
      s.border_gradient.noalias() -= s.border[i] * g;
    }
    if (i + 1 == n) break;
    const BorderedSystem::Block toward_next = factor.solve(s.coupling[i].transpose());
    s.diagonal[i + 1].noalias() -= s.coupling[i] * toward_next;
    s.gradient[i + 1].noalias() -= s.coupling[i] * g;
    if (has_border) s.border[i + 1].noalias() -= s.border[i] * toward_next;
  }
  BorderedSolution solution;
  solution.border = Eigen::VectorXd::Zero(border_size);
  if (has_border) {
    const Eigen::LLT<Eigen::MatrixXd> corner(s.corner);
    if (corner.info() != Eigen::Success) return std::nullopt;
    solution.border = corner.solve(s.border_gradient);
    solution.border_covariance = corner.solve(Eigen::MatrixXd::Identity(border_size, border_size));
  }
  solution.knots.resize(n);
  for (std::size_t i = n; i-- > 0;) {
    BorderedSystem::BlockVector g = s.gradient[i];
    if (has_border) g -= s.border[i].transpose() * solution.border;
    if (i + 1 < n) g -= s.coupling[i].transpose() * solution.knots[i + 1];
    solution.knots[i] = factors[i].solve(g);
  }
  return solution;
}

}  // namespace alidade
