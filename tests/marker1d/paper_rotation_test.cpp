// SPDX-License-Identifier: Apache-2.0
#include "marker1d/paper_rotation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 41;

// Up to an angle of 72°.
Eigen::Vector3d random_parameters(test::RandomGeometry& random) {
  return random.uniform(0.0, 0.95) * random.direction();
}

TEST(PaperRotation, IsTheRotationAboutPByItsArcSine) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector3d P = random_parameters(random);
    const Eigen::Matrix3d expected = exp_so3(std::asin(P.norm()) * P.normalized());
    EXPECT_LT((paper_rotation(P) - expected).norm(), 1e-14) << "seed " << kSeed;
  }
  EXPECT_EQ(paper_rotation(Eigen::Vector3d::Zero()), Eigen::Matrix3d::Identity());
}

// A11 = c + βp², A12 = βpq - r, A13 = βpr + q.
TEST(PaperRotation, HasTheElementsWrittenOut) {
  const Eigen::Matrix3d A = paper_rotation({0.3, -0.2, 0.5});
  const double c = std::sqrt(1 - 0.09 - 0.04 - 0.25), beta = 1 / (1 + c);
  EXPECT_DOUBLE_EQ(A(0, 0), c + beta * 0.09);
  EXPECT_DOUBLE_EQ(A(0, 1), -beta * 0.06 - 0.5);
  EXPECT_DOUBLE_EQ(A(0, 2), beta * 0.15 - 0.2);
}

TEST(PaperRotation, ParametersAreTheInverse) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Vector3d P = random_parameters(random);
    EXPECT_LT((paper_parameters(paper_rotation(P)) - P).norm(), 1e-15) << "seed " << kSeed;
  }
}

// Central differences of step h err by h² and by rounding / h: combined over two steps (Richardson), by h⁴.
template <class Function>
auto derivative(const Function& of, const Eigen::Vector3d& P, int j) {
  const auto central = [&](double h) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(j);
    return Eigen::Matrix3d((of(Eigen::Vector3d(P + step)) - of(Eigen::Vector3d(P - step))) / (2 * h));
  };
  return Eigen::Matrix3d((4.0 * central(5e-4) - central(1e-3)) / 3.0);
}

TEST(PaperRotation, FirstDerivativesAreThoseOfDifferences) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 30; ++trial) {
    const Eigen::Vector3d P = 0.8 * random_parameters(random);
    const PaperRotation rotation = differentiate_paper_rotation(P);
    EXPECT_LT((rotation.A - paper_rotation(P)).norm(), 1e-15);
    for (int j = 0; j < 3; ++j) {
      const Eigen::Matrix3d expected = derivative(paper_rotation, P, j);
      EXPECT_LT((rotation.A_j[j] - expected).norm(), 1e-9 * expected.norm()) << "j " << j << ", seed " << kSeed;
    }
  }
}

TEST(PaperRotation, SecondDerivativesAreThoseOfDifferencesOfTheFirst) {
  test::RandomGeometry random(kSeed);
  for (int trial = 0; trial < 30; ++trial) {
    const Eigen::Vector3d P = 0.8 * random_parameters(random);
    const PaperRotation rotation = differentiate_paper_rotation(P);
    for (int j = 0; j < 3; ++j) {
      const auto A_j = [j](const Eigen::Vector3d& at) { return differentiate_paper_rotation(at).A_j[j]; };
      for (int k = 0; k < 3; ++k) {
        const Eigen::Matrix3d expected = derivative(A_j, P, k);
        EXPECT_LT((rotation.A_jk[j][k] - expected).norm(), 1e-9 * expected.norm())
            << "j " << j << ", k " << k << ", seed " << kSeed;
      }
    }
  }
}

TEST(PaperRotation, RefusesParametersBeyondARightAngle) {
  EXPECT_THROW(paper_rotation({0.6, 0.8, 0.1}), std::invalid_argument);
  EXPECT_THROW(differentiate_paper_rotation({1, 0, 0}), std::invalid_argument);
  EXPECT_THROW(paper_rotation({std::nan(""), 0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
