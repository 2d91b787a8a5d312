// SPDX-License-Identifier: Apache-2.0
#include "reconstruction/resection.h"

#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/support/synthetic_scene.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 29;
constexpr PnpMethod kMethods[] = {PnpMethod::Epnp, PnpMethod::EpnpLm, PnpMethod::Sqpnp};

class Resection : public testing::Test {
 protected:
  void see(int points, double noise_px) {
    map_ = test::make_map(camera_, points, 1, noise_px, random_);
    truth_ = map_.keyframes[0].T_world_camera;
    observations_ = test::observations_of(map_, 0);
  }

  void spoil(std::size_t of_ten) {
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      if (i % 10 >= of_ten) continue;
      observations_[i].pixel = {random_.uniform(0, 640), random_.uniform(0, 480)};
    }
  }

  test::RandomGeometry random_{kSeed};
  Camera camera_ = test::vga_camera();
  PointMap map_;
  Eigen::Isometry3d truth_;
  std::vector<PointObservation> observations_;
};

TEST_F(Resection, IsExactOnExactSightings) {
  see(60, 0);
  for (const PnpMethod method : kMethods) {
    const auto T = solve_pnp(camera_, observations_, method);
    ASSERT_TRUE(T) << static_cast<int>(method);
    EXPECT_LT(difference(truth_, *T).norm(), 1e-5) << static_cast<int>(method);
  }
}

// Half a pixel at f = 520 px over about 50 points 6 m away: a few millimetres.
TEST_F(Resection, IsNearWithNoise) {
  see(60, 0.5);
  for (const PnpMethod method : kMethods) {
    const auto T = solve_pnp(camera_, observations_, method);
    ASSERT_TRUE(T);
    EXPECT_LT(difference(truth_, *T).head<3>().norm(), 0.05) << static_cast<int>(method);
  }
}

TEST_F(Resection, IsEmptyBelowSixSightings) {
  see(60, 0);
  observations_.resize(5);
  for (const PnpMethod method : kMethods) EXPECT_FALSE(solve_pnp(camera_, observations_, method));
}

TEST_F(Resection, IsEmptyWhereAllPointsCoincide) {
  see(10, 0);
  const std::vector<PointObservation> one_place(20, observations_[0]);
  for (const PnpMethod method : kMethods) {
    EXPECT_FALSE(solve_pnp(camera_, one_place, method)) << static_cast<int>(method);
  }
  EXPECT_FALSE(solve_pnp_ransac(camera_, one_place));
  EXPECT_FALSE(resection_covariance(camera_, truth_, one_place));
}

TEST_F(Resection, IsEmptyWhereAllPointsLieOnOneLine) {
  see(60, 0);
  for (std::size_t i = 0; i < observations_.size(); ++i) {
    observations_[i].p_world = Eigen::Vector3d(-1, 0.5, 0.2) + 0.03 * static_cast<double>(i) * Eigen::Vector3d(1, 2, 1);
    observations_[i].pixel = project(camera_, truth_.inverse() * observations_[i].p_world)->pixel;
  }
  for (const PnpMethod method : kMethods) {
    EXPECT_FALSE(solve_pnp(camera_, observations_, method)) << static_cast<int>(method);
  }
}

TEST_F(Resection, ByRansacBearsFortyPercentOfOutliers) {
  see(120, 0.5);
  spoil(4);
  const auto pose = solve_pnp_ransac(camera_, observations_);
  ASSERT_TRUE(pose);
  EXPECT_LT(difference(truth_, pose->T_world_camera).head<3>().norm(), 0.05);
  std::vector<bool> is_inlier(observations_.size(), false);
  for (int i : pose->inliers) is_inlier[static_cast<std::size_t>(i)] = true;
  int wrong = 0;
  for (std::size_t i = 0; i < is_inlier.size(); ++i) wrong += is_inlier[i] == (i % 10 < 4);
  EXPECT_LE(wrong, 2) << "an outlier may land near its point";
}

TEST_F(Resection, ByRansacIsTheSameTwice) {
  see(120, 0.5);
  spoil(4);
  const auto first = solve_pnp_ransac(camera_, observations_);
  const auto second = solve_pnp_ransac(camera_, observations_);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->T_world_camera.matrix(), second->T_world_camera.matrix());
  EXPECT_EQ(first->inliers, second->inliers);
}

TEST_F(Resection, ByRansacIsEmptyWhereFewAgree) {
  see(120, 0.5);
  spoil(10);
  EXPECT_FALSE(solve_pnp_ransac(camera_, observations_));
  EXPECT_FALSE(solve_pnp_ransac(camera_, {}));
}

// (Σ JᵀJ/σ²)⁻¹ by central differences; residuals of twice the announced size double its standard deviations.
TEST_F(Resection, HasTheCovarianceOfItsResiduals) {
  see(80, 0);
  for (PointObservation& o : observations_) o.sigma_px = 0.5;
  Matrix6d information = Matrix6d::Zero();
  for (const PointObservation& o : observations_) {
    Eigen::Matrix<double, 2, 6> J;
    for (int i = 0; i < 6; ++i) {
      const Vector6d step = 1e-6 * Vector6d::Unit(i);
      J.col(i) = (project(camera_, (truth_ * perturbation(step)).inverse() * o.p_world)->pixel -
                  project(camera_, (truth_ * perturbation(-step)).inverse() * o.p_world)->pixel) /
                 2e-6;
    }
    information += J.transpose() * J / 0.25;
  }
  const auto covariance = resection_covariance(camera_, truth_, observations_);
  ASSERT_TRUE(covariance);
  EXPECT_LT((*covariance * information - Matrix6d::Identity()).cwiseAbs().maxCoeff(), 1e-4);

  for (std::size_t i = 0; i < observations_.size(); ++i) observations_[i].pixel.x() += i % 2 == 0 ? 1.0 : -1.0;
  const double n = static_cast<double>(observations_.size());
  const double variance = 4.0 * n / (2 * n - 6);
  const Matrix6d larger = *resection_covariance(camera_, truth_, observations_);
  EXPECT_LT((larger / variance - *covariance).norm() / covariance->norm(), 1e-9);
}

TEST_F(Resection, HasNoCovarianceFromTooFewSightings) {
  see(60, 0);
  observations_.resize(5);
  EXPECT_FALSE(resection_covariance(camera_, truth_, observations_));
}

// What remains of the outliers after reselection would show in millimetres.
TEST_F(Resection, RansacWithLmIsThatOfTheInliersAlone) {
  see(100, 0.5);
  spoil(4);
  std::vector<PointObservation> clean;
  for (std::size_t i = 0; i < observations_.size(); ++i) {
    if (i % 10 >= 4) clean.push_back(observations_[i]);
  }
  const auto T = solve_pnp_ransac_lm(camera_, observations_, 0.5);
  const auto T_clean = solve_pnp(camera_, clean, PnpMethod::EpnpLm);
  ASSERT_TRUE(T && T_clean);
  EXPECT_LT(difference(*T_clean, *T).norm(), 2e-3);
}

TEST_F(Resection, RansacWithLmIsEmptyWhereNothingAgrees) {
  see(60, 0.5);
  spoil(10);
  EXPECT_FALSE(solve_pnp_ransac_lm(camera_, observations_, 0.5));
}

}  // namespace
}  // namespace alidade
