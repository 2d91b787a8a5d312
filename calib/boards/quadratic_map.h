// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

namespace alidade {

/// A function of a place on a board (m) with values in the image (px), by polynomials of second degree: what a lens
/// adds to the perspective over a few squares.
class QuadraticMap {
 public:
  /// Through points about `centre` that lie within about `size_m` of it, without those that contradict most others:
  /// from eight on, in three rows and columns; empty with fewer.
  static std::optional<QuadraticMap> fit(std::span<const Eigen::Vector2d> on_board,
                                         std::span<const Eigen::Vector2d> values_px, const Eigen::Vector2d& centre,
                                         double size_m);

  Eigen::Vector2d at(const Eigen::Vector2d& p_board) const;

 private:
  Eigen::Vector2d centre_;
  double size_m_ = 1;
  Eigen::Matrix<double, 6, 2> coefficients_;
};

}  // namespace alidade
