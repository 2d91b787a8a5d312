// SPDX-License-Identifier: Apache-2.0
#include "evaluation/truth_covariance.h"

#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace alidade {
namespace {

constexpr unsigned kSeed = 61;

// Metres and radians of a motion capture system, correlated.
Matrix6d example_covariance() {
  Vector6d sigma;
  sigma << 0.004, 0.006, 0.003, 0.005, 0.002, 0.003;
  Matrix6d correlation = Matrix6d::Identity();
  correlation(0, 4) = correlation(4, 0) = 0.6;
  correlation(1, 3) = correlation(3, 1) = -0.5;
  return sigma.asDiagonal() * correlation * sigma.asDiagonal();
}

class Residuals {
 public:
  Vector6d drawn(const Matrix6d& covariance) {
    Vector6d normal;
    for (double& x : normal) x = standard_(random_);
    return covariance.llt().matrixL() * normal;
  }

  std::vector<MotionResidual> of(int count, const Matrix6d& truth, const Matrix6d& measured, const Matrix6d& claimed) {
    std::vector<MotionResidual> residuals;
    for (int i = 0; i < count; ++i) {
      residuals.push_back({drawn(truth) - drawn(truth) + drawn(measured), claimed});
    }
    return residuals;
  }

 private:
  std::mt19937_64 random_{kSeed};
  std::normal_distribution<double> standard_;
};

TEST(TruthCovariance, IsWhatTheMotionsDoNotExplain) {
  const Matrix6d truth = example_covariance(), measured = 0.5 * truth.diagonal().asDiagonal().toDenseMatrix();
  const auto P = truth_covariance(Residuals().of(40000, truth, measured, measured));
  ASSERT_TRUE(P);
  const Vector6d per_sigma = truth.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix6d off = per_sigma.asDiagonal() * (*P - truth) * per_sigma.asDiagonal();
  // Of a second moment of 2.5 variances from 40000 samples, halved: sigma 0.5 * 2.5 * sqrt(2 / 40000) = 0.009.
  EXPECT_LT(off.cwiseAbs().maxCoeff(), 0.045) << "seed " << kSeed;
}

TEST(TruthCovariance, HasNoNegativeVariance) {
  const Matrix6d truth = 1e-4 * example_covariance(), measured = example_covariance();
  const auto P = truth_covariance(Residuals().of(200, truth, measured, 4.0 * measured));
  ASSERT_TRUE(P);
  EXPECT_LT(P->norm(), 1e-12);
}

TEST(TruthCovariance, IsEmptyForFewerResidualsThanDetermineIt) {
  const Matrix6d any = example_covariance();
  EXPECT_FALSE(truth_covariance({}));
  EXPECT_FALSE(truth_covariance(Residuals().of(6, any, any, any)));
  EXPECT_TRUE(truth_covariance(Residuals().of(7, any, any, any)));
}

}  // namespace
}  // namespace alidade
