// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "estimation/pose_update.h"
#include "tests/support/synthetic_scene.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 101;

// A body of 0.4 m that was triangulated from 2 m away, with relative depth noise, and is now seen from `angle` round
// it.
struct SideView {
  static constexpr double kNoise_px = 0.5;

  SideView(double depth_noise, double angle, int points, test::RandomGeometry& random) {
    const Eigen::Vector3d from(2, 0, 0);
    truth = test::looking_at({2 * std::cos(angle), 2 * std::sin(angle), 0.1}, {0, 0, 0});
    for (int i = 0; i < points; ++i) {
      const Eigen::Vector3d p(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2));
      const Eigen::Vector3d d = (p - from).normalized();
      const double inverse_distance = 1 / (p - from).norm(), sigma = depth_noise * inverse_distance;
      const double found = 1 / (inverse_distance + random.normal(sigma));
      PointObservation o;
      o.pixel = project(camera, truth.inverse() * p)->pixel +
                Eigen::Vector2d(random.normal(kNoise_px), random.normal(kNoise_px));
      o.sigma_px = kNoise_px;
      o.p_world = from + found * d + random.vector(1e-3);
      o.covariance_world =
          1e-6 * Eigen::Matrix3d::Identity() + found * found * found * found * sigma * sigma * d * d.transpose();
      o.seen_from = from;
      observations.push_back(o);
    }
    prior.T_world_camera = truth;
    prior.information = 1e-6 * Matrix6d::Identity();
  }

  PoseUpdate update(MapUncertainty map_uncertainty) const {
    PoseUpdateOptions options;
    options.map_uncertainty = map_uncertainty;
    options.gate_chi2 = 30;
    options.loosest_gate_px = 1e3;
    return update_pose(camera, prior, observations, options).value();
  }

  Camera camera = test::vga_camera();
  Eigen::Isometry3d truth;
  std::vector<PointObservation> observations;
  PosePrior prior;
};

// Depths to 8 %, 16 cm of a body of 40 cm; the mean error of many draws is the bias.
TEST(MapUncertainty, BiasesThePoseMuchLessWhereThePointsAreRefitted) {
  constexpr int kTrials = 100;
  Vector6d refitted = Vector6d::Zero(), inflated = Vector6d::Zero();
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    test::RandomGeometry random(kSeed + trial);
    const SideView view(0.08, std::numbers::pi / 3, 60, random);
    refitted += difference(view.truth, view.update(MapUncertainty::Refitted).T_world_camera) / kTrials;
    inflated += difference(view.truth, view.update(MapUncertainty::Inflated).T_world_camera) / kTrials;
  }
  EXPECT_LT(refitted.head<3>().norm(), 0.1 * inflated.head<3>().norm()) << "seed " << kSeed;
  EXPECT_LT(refitted.tail<3>().norm(), 0.1 * inflated.tail<3>().norm()) << "seed " << kSeed;
}

// The mean over 200 trials has mean 6 and variance 12/200: 99.9 % of means lie within 0.81 of 6.
TEST(MapUncertainty, LeavesAnHonestCovarianceWhereThePointsAreRefitted) {
  double sum = 0.0;
  for (unsigned trial = 0; trial < 200; ++trial) {
    test::RandomGeometry random(kSeed + trial);
    const SideView view(0.02, std::numbers::pi / 3, 60, random);
    const PoseUpdate update = view.update(MapUncertainty::Refitted);
    const Vector6d error = difference(update.T_world_camera, view.truth);
    sum += error.dot(update.covariance.ldlt().solve(error));
  }
  EXPECT_NEAR(sum / 200, 6.0, 0.81) << "seed " << kSeed;
}

// What pose and points, which are chosen best for each pose, make least together.
double joint_cost(const SideView& view, const Eigen::Isometry3d& T_world_camera) {
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  double sum = 0.0;
  for (const PointObservation& o : view.observations) {
    const double variance = o.sigma_px * o.sigma_px;
    UncertainPoint point(o.p_world, o.covariance_world, o.seen_from);
    for (int step = 0; step < 20; ++step) point.refit(view.camera, T_camera_world, o.pixel, variance);
    const auto sighting = point.linearise(view.camera, T_camera_world, o.pixel, variance);
    sum += sighting->residual.dot(sighting->R.inverse() * sighting->residual);
  }
  return sum;
}

TEST(MapUncertainty, IsRefittedToTheJointOptimum) {
  test::RandomGeometry random(kSeed);
  const SideView view(0.03, std::numbers::pi / 3, 60, random);
  const PoseUpdate update = view.update(MapUncertainty::Refitted);
  ASSERT_EQ(update.inlier_count, 60);
  Vector6d gradient;
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = 1e-5 * Vector6d::Unit(i);
    gradient(i) = (joint_cost(view, update.T_world_camera * perturbation(step)) -
                   joint_cost(view, update.T_world_camera * perturbation(-step))) /
                  2e-5;
  }
  // How many standard deviations a Newton step would still move.
  EXPECT_LT(0.5 * std::sqrt(gradient.dot(update.covariance * gradient)), 0.05) << gradient.transpose();
}

TEST(MapUncertainty, ChangesNothingOfAnExactMap) {
  test::RandomGeometry random(kSeed);
  SideView view(0.0, 0.5, 60, random);
  for (PointObservation& o : view.observations) o.covariance_world.setZero();
  const PoseUpdate ignored = view.update(MapUncertainty::Ignored);
  for (const MapUncertainty kind : {MapUncertainty::Inflated, MapUncertainty::Refitted}) {
    EXPECT_LT(difference(ignored.T_world_camera, view.update(kind).T_world_camera).norm(), 1e-9);
  }
}

TEST(MapUncertainty, IsIgnoredWhereItIsTold) {
  test::RandomGeometry random(kSeed);
  SideView view(0.01, 0.3, 60, random);
  const PoseUpdate before = view.update(MapUncertainty::Ignored);
  for (PointObservation& o : view.observations) o.covariance_world *= 9;
  const PoseUpdate after = view.update(MapUncertainty::Ignored);
  EXPECT_EQ(before.T_world_camera.matrix(), after.T_world_camera.matrix());
  EXPECT_EQ(before.covariance, after.covariance);
}

class SightingsLikelihood : public testing::Test {
 protected:
  // Forty exact points by 2 px, and a prior as sure as they are that is two standard deviations off.
  SightingsLikelihood() {
    map_ = test::make_map(camera_, 40, 1, 2.0, random_);
    observations_ = test::observations_of(map_, 0);
    observations_[3].pixel.x() += 40;  // an outlier: no part of the likelihood
    const Eigen::Isometry3d truth = map_.keyframes[0].T_world_camera;
    const Matrix6d P = update_pose(camera_, {truth, 1e-6 * Matrix6d::Identity()}, observations_)->covariance;
    prior_.information = P.inverse();
    Vector6d draw;
    draw << 1, -1, 0.5, 1, 0.5, -1;
    prior_.T_world_camera = truth * perturbation(P.llt().matrixL() * draw);
    update_ = update_pose(camera_, prior_, observations_).value();
  }

  double log_density(const Eigen::Isometry3d& T_world_camera) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      if (!update_.is_inlier[i]) continue;
      const PointObservation& o = observations_[i];
      const Eigen::Vector2d off = o.pixel - project(camera_, T_world_camera.inverse() * o.p_world)->pixel;
      sum -= 0.5 * off.squaredNorm() / (o.sigma_px * o.sigma_px);
    }
    return sum;
  }

  test::RandomGeometry random_{kSeed};
  Camera camera_ = test::vga_camera();
  PointMap map_;
  std::vector<PointObservation> observations_;
  PosePrior prior_;
  PoseUpdate update_;
};

TEST_F(SightingsLikelihood, HasTheGradientOfItsLogarithm) {
  const PoseLikelihood& sightings = update_.sightings;
  ASSERT_EQ(update_.inlier_count, static_cast<int>(observations_.size()) - 1);
  Vector6d gradient;
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = 1e-6 * Vector6d::Unit(i);
    gradient(i) = (log_density(sightings.T_world_body * perturbation(step)) -
                   log_density(sightings.T_world_body * perturbation(-step))) /
                  2e-6;
  }
  EXPECT_GT(std::sqrt(gradient.dot(update_.covariance * gradient)), 0.5);
  EXPECT_LT((gradient - sightings.gradient).norm(), 1e-6 * gradient.norm());
}

TEST_F(SightingsLikelihood, GivesTheResultTogetherWithThePrior) {
  const PoseLikelihood& sightings = update_.sightings;
  const Matrix6d information = sightings.information + prior_.information;
  const Vector6d to_prior = difference(sightings.T_world_body, prior_.T_world_camera);
  const Vector6d pull = information.ldlt().solve(prior_.information * to_prior);
  const Vector6d xi = information.ldlt().solve(sightings.gradient) + pull;
  const Vector6d off = difference(sightings.T_world_body, update_.T_world_camera) - xi;
  EXPECT_GT(std::sqrt(pull.dot(information * pull)), 0.5);
  EXPECT_LT(std::sqrt(off.dot(information * off)), 1e-2);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> ratios(update_.covariance, information.inverse());
  EXPECT_GT(ratios.eigenvalues().minCoeff(), 0.98);
  EXPECT_LT(ratios.eigenvalues().maxCoeff(), 1.02);
}

// The factor is on sigma_px²: four times the variance are twice the sigma.
TEST_F(SightingsLikelihood, CountsTheVarianceFactor) {
  PoseUpdateOptions options;
  options.variance_factor = 4.0;
  const PoseUpdate by_factor = update_pose(camera_, prior_, observations_, options).value();
  for (PointObservation& o : observations_) o.sigma_px *= 2;
  const PoseUpdate by_sigma = update_pose(camera_, prior_, observations_).value();
  EXPECT_LT(difference(by_factor.T_world_camera, by_sigma.T_world_camera).norm(), 1e-12);
  EXPECT_LT((by_factor.covariance - by_sigma.covariance).norm(), 1e-12 * by_sigma.covariance.norm());
}

}  // namespace
}  // namespace alidade
