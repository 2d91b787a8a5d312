// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/bordered_system.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace alidade {
namespace {

// A positive definite system of `knots` and `border` parameters, and the same as one dense matrix.
struct Both {
  BorderedSystem bordered;
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
};

Both make_system(int knots, int border) {
  std::srand(7);
  const Eigen::Index n = 12 * knots + border;
  Both both{BorderedSystem(static_cast<std::size_t>(knots), border), Eigen::MatrixXd::Zero(n, n),
            Eigen::VectorXd::Random(n)};
  for (int k = 0; k + 1 < std::max(knots, 2); ++k) {  // rows that see two knots and the border
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(40, n);
    J.middleCols(12 * k, std::min(24, 12 * knots)) = Eigen::MatrixXd::Random(40, std::min(24, 12 * knots));
    J.rightCols(border) = Eigen::MatrixXd::Random(40, border);
    both.H += J.transpose() * J;
  }
  for (int k = 0; k < knots; ++k) {
    const auto i = static_cast<std::size_t>(k);
    both.bordered.diagonal[i] = both.H.block<12, 12>(12 * k, 12 * k);
    if (k + 1 < knots) both.bordered.coupling[i] = both.H.block<12, 12>(12 * (k + 1), 12 * k);
    both.bordered.border[i] = both.H.block(12 * knots, 12 * k, border, 12);
    both.bordered.gradient[i] = both.g.segment<12>(12 * k);
  }
  both.bordered.corner = both.H.bottomRightCorner(border, border);
  both.bordered.border_gradient = both.g.tail(border);
  return both;
}

TEST(BorderedSystem, IsSolvedAsTheDenseMatrix) {
  for (const int knots : {1, 2, 7}) {
    for (const int border : {0, 1, 9}) {
      const Both both = make_system(knots, border);
      for (const double damping : {0.0, 0.1}) {
        Eigen::MatrixXd H = both.H;
        H.diagonal() *= 1.0 + damping;
        const Eigen::VectorXd expected = H.ldlt().solve(both.g);
        const auto found = solve(both.bordered, damping);
        ASSERT_TRUE(found);
        for (int k = 0; k < knots; ++k) {
          EXPECT_LT((found->knots[static_cast<std::size_t>(k)] - expected.segment<12>(12 * k)).norm(), 1e-9);
        }
        EXPECT_LT((found->border - expected.tail(border)).norm(), 1e-9);
        if (border == 0) continue;
        const Eigen::MatrixXd C = H.inverse().bottomRightCorner(border, border);
        EXPECT_LT((found->border_covariance - C).norm(), 1e-8 * C.norm());
      }
    }
  }
}

TEST(BorderedSystem, IsEmptyWhereItIsNotPositiveDefinite) {
  Both both = make_system(3, 2);
  both.bordered.diagonal[1].setZero();
  EXPECT_FALSE(solve(both.bordered, 0.0));
  both = make_system(3, 2);
  both.bordered.corner.setZero();
  EXPECT_FALSE(solve(both.bordered, 0.0));
}

}  // namespace
}  // namespace alidade
