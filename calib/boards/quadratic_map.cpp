// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/quadratic_map.h"

#include <algorithm>
#include <vector>

#include <Eigen/QR>

namespace alidade {
namespace {

using Eigen::Vector2d;
using Row = Eigen::Matrix<double, 1, 6>;

constexpr std::ptrdiff_t kLeast = 8;

Row monomials(const Vector2d& p) {
  return {1, p.x(), p.y(), p.x() * p.x(), p.x() * p.y(), p.y() * p.y()};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::optional<QuadraticMap> QuadraticMap::fit(std::span<const Vector2d> on_board, std::span<const Vector2d> values_px,
                                              const Vector2d& centre, double size_m) {
  constexpr int kRounds = 4;
  constexpr double kOverMedian = 4, kLeast_px = 0.2;
  QuadraticMap map;
  map.centre_ = centre;
  map.size_m_ = size_m;
  std::vector<bool> is_used(on_board.size(), true);
  for (int round = 0; round < kRounds; ++round) {
    const auto used = std::count(is_used.begin(), is_used.end(), true);
    if (used < kLeast) return std::nullopt;
    Eigen::Matrix<double, Eigen::Dynamic, 6> A(used, 6);
    Eigen::Matrix<double, Eigen::Dynamic, 2> b(used, 2);
    for (std::size_t i = 0, row = 0; i < on_board.size(); ++i) {
      if (!is_used[i]) continue;
      A.row(static_cast<Eigen::Index>(row)) = monomials((on_board[i] - centre) / size_m);
      b.row(static_cast<Eigen::Index>(row++)) = values_px[i].transpose();
    }
    const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, 6>> qr(A);
    if (qr.rank() < 6) return std::nullopt;
    map.coefficients_ = qr.solve(b);
    std::vector<double> errors;
    for (std::size_t i = 0; i < on_board.size(); ++i) errors.push_back((map.at(on_board[i]) - values_px[i]).norm());
    const double most = std::max(kLeast_px, kOverMedian * median(errors));
    for (std::size_t i = 0; i < errors.size(); ++i) is_used[i] = errors[i] <= most;
  }
  return map;
}

Vector2d QuadraticMap::at(const Vector2d& p_board) const {
  return (monomials((p_board - centre_) / size_m_) * coefficients_).transpose();
}

}  // namespace alidade
