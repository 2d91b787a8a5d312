// SPDX-License-Identifier: Apache-2.0
#include "estimation/pose_update.h"

#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "tests/support/synthetic_scene.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 41;

Matrix6d prior_covariance(double sigma_m, double sigma_rad) {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(sigma_m * sigma_m), Eigen::Vector3d::Constant(sigma_rad * sigma_rad);
  return variances.asDiagonal();
}

Vector6d draw(test::RandomGeometry& random, double sigma_m, double sigma_rad) {
  Vector6d xi;
  xi << random.vector(sigma_m), random.vector(sigma_rad);
  return xi;
}

class UpdatePose : public testing::Test {
 protected:
  // Exact sightings from a known pose, and a prior a few centimetres and degrees off that knows next to nothing.
  UpdatePose() {
    map_ = test::make_map(camera_, 80, 1, 0.0, random_);
    truth_ = map_.keyframes[0].T_world_camera;
    observations_ = test::observations_of(map_, 0);
    Vector6d off;
    off << 0.05, -0.04, 0.06, 0.01, -0.012, 0.01;
    prior_.T_world_camera = truth_ * perturbation(off);
    prior_.information = 1e-6 * Matrix6d::Identity();
  }

  test::RandomGeometry random_{kSeed};
  Camera camera_ = test::vga_camera();
  PointMap map_;
  Eigen::Isometry3d truth_;
  std::vector<PointObservation> observations_;
  PosePrior prior_;
};

TEST_F(UpdatePose, RecoversTheExactPoseFromExactSightings) {
  const auto update = update_pose(camera_, prior_, observations_);
  ASSERT_TRUE(update);
  EXPECT_LT(difference(truth_, update->T_world_camera).norm(), 1e-7);
  EXPECT_EQ(update->inlier_count, static_cast<int>(observations_.size()));
  EXPECT_EQ(update->is_inlier.size(), observations_.size());
  EXPECT_LT(update->chi2_per_dof, 1e-8);
}

TEST_F(UpdatePose, RejectsThirtyPercentOfOutliers) {
  std::vector<bool> is_outlier(observations_.size(), false);
  for (std::size_t i = 0; i < observations_.size(); ++i) {
    observations_[i].pixel += Eigen::Vector2d(random_.normal(0.5), random_.normal(0.5));
    if (i % 10 >= 3) continue;
    is_outlier[i] = true;
    const double angle = random_.uniform(0, 6.28);
    observations_[i].pixel += random_.uniform(8, 50) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  for (PointObservation& o : observations_) o.sigma_px = 0.5;
  prior_.information = prior_covariance(0.1, 0.02).inverse();
  const auto update = update_pose(camera_, prior_, observations_);
  ASSERT_TRUE(update);
  for (std::size_t i = 0; i < is_outlier.size(); ++i) EXPECT_NE(update->is_inlier[i], is_outlier[i]) << i;
  const Vector6d error = difference(truth_, update->T_world_camera);
  EXPECT_LT(error.dot(update->covariance.ldlt().solve(error)), 22.5) << "chi2 of 6 degrees of freedom, 99.9 %";
  EXPECT_NEAR(update->chi2_per_dof, 1.0, 0.5);
}

TEST_F(UpdatePose, StaysAtThePriorWhereTheSightingsSayLittle) {
  for (PointObservation& o : observations_) o.sigma_px = 1e4;
  prior_.information = prior_covariance(0.01, 0.002).inverse();
  const auto update = update_pose(camera_, prior_, observations_);
  ASSERT_TRUE(update);
  EXPECT_LT(difference(prior_.T_world_camera, update->T_world_camera).norm(), 1e-5);
  const Matrix6d whitened = update->covariance * prior_.information;
  EXPECT_LT((whitened - Matrix6d::Identity()).cwiseAbs().maxCoeff(), 1e-3);
}

// The cost that the most probable pose makes least: sightings and prior, each in standard deviations.
double cost(const Camera& camera, const PosePrior& prior, const std::vector<PointObservation>& observations,
            const Eigen::Isometry3d& T) {
  const Vector6d off = difference(prior.T_world_camera, T);
  double sum = off.dot(prior.information * off);
  for (const PointObservation& o : observations) {
    sum += (o.pixel - project(camera, T.inverse() * o.p_world)->pixel).squaredNorm() / (o.sigma_px * o.sigma_px);
  }
  return sum;
}

// A prior about as strong as the sightings, and 0.14 rad from them: both must have moved the pose.
TEST_F(UpdatePose, IsWhereThePosteriorIsGreatest) {
  observations_.resize(12);
  for (PointObservation& o : observations_) {
    o.pixel += Eigen::Vector2d(random_.normal(20), random_.normal(20));
    o.sigma_px = 20;
  }
  Vector6d off;
  off << 0.2, -0.15, 0.1, 0.08, -0.08, 0.08;
  prior_.T_world_camera = truth_ * perturbation(off);
  Vector6d weights;
  weights << 1, 3, 0.5, 0.5, 1, 2;
  prior_.information = weights.asDiagonal() * prior_covariance(0.3, 0.06).inverse();
  PoseUpdateOptions options;
  options.loosest_gate_px = 1e3;
  options.gate_chi2 = 1e3;
  options.max_iterations = 60;
  const auto update = update_pose(camera_, prior_, observations_, options);
  ASSERT_TRUE(update);
  EXPECT_GT(difference(prior_.T_world_camera, update->T_world_camera).norm(), 0.05);
  Vector6d gradient;
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = 1e-5 * Vector6d::Unit(i);
    gradient(i) = (cost(camera_, prior_, observations_, update->T_world_camera * perturbation(step)) -
                   cost(camera_, prior_, observations_, update->T_world_camera * perturbation(-step))) /
                  2e-5;
  }
  // How many standard deviations a Newton step would still move.
  EXPECT_LT(0.5 * std::sqrt(gradient.dot(update->covariance * gradient)), 1e-3) << gradient.transpose();
}

// Without a prior the information is the sum of JᵀR⁻¹J, here by central differences of the projection.
TEST_F(UpdatePose, HasTheInformationOfCentralDifferences) {
  prior_.information.setZero();
  for (PointObservation& o : observations_) o.sigma_px = 0.7;
  const auto update = update_pose(camera_, prior_, observations_);
  ASSERT_TRUE(update);
  Matrix6d information = Matrix6d::Zero();
  for (const PointObservation& o : observations_) {
    Eigen::Matrix<double, 2, 6> J;
    for (int i = 0; i < 6; ++i) {
      const Vector6d step = 1e-6 * Vector6d::Unit(i);
      J.col(i) = (project(camera_, (truth_ * perturbation(step)).inverse() * o.p_world)->pixel -
                  project(camera_, (truth_ * perturbation(-step)).inverse() * o.p_world)->pixel) /
                 2e-6;
    }
    information += J.transpose() * J / (0.7 * 0.7);
  }
  EXPECT_LT((update->covariance * information - Matrix6d::Identity()).cwiseAbs().maxCoeff(), 1e-4);
}

struct Spread {
  double sigma_m, sigma_rad;  // of the prior
  double map_m;               // of the map's points along each axis, at most
};

// Mean of eᵀP⁻¹e over trials in which prior, map and pixels are drawn from what the update is told of them.
double mean_nees(const Spread& spread, int trials) {
  double sum = 0;
  for (int trial = 0; trial < trials; ++trial) {
    test::RandomGeometry random(kSeed + static_cast<unsigned>(trial));
    const Camera camera = test::vga_camera();
    PointMap map = test::make_map(camera, 25, 1, 0.8, random);
    for (MapPoint& point : map.points) {
      Eigen::Matrix3d A;
      A << random.vector(), random.vector(), random.vector();
      A *= 0.5 * spread.map_m;
      point.covariance_world = A * A.transpose();
      point.p_world += A * random.vector();
    }
    PosePrior prior;
    prior.T_world_camera =
        map.keyframes[0].T_world_camera * perturbation(draw(random, spread.sigma_m, spread.sigma_rad));
    prior.information = prior_covariance(spread.sigma_m, spread.sigma_rad).inverse();
    PoseUpdateOptions options;
    options.loosest_gate_px = 1e3;
    options.gate_chi2 = 30;  // a gate at 99.9 % would trim the statistic that is measured
    const auto update = update_pose(camera, prior, test::observations_of(map, 0), options);
    if (!update) return -1;
    const Vector6d error = difference(map.keyframes[0].T_world_camera, update->T_world_camera);
    sum += error.dot(update->covariance.ldlt().solve(error));
  }
  return sum / trials;
}

// The mean over 200 trials has mean 6 and variance 12/200: 99.9 % of means lie within 0.81 of 6.
TEST(UpdatePoseConsistency, HoldsWithAKnownMap) {
  EXPECT_NEAR(mean_nees({0.02, 0.005, 0.0}, 200), 6.0, 0.81) << "seed " << kSeed;
}

TEST(UpdatePoseConsistency, HoldsWithAnUncertainMap) {
  EXPECT_NEAR(mean_nees({0.02, 0.005, 0.03}, 200), 6.0, 0.81) << "seed " << kSeed;
}

TEST(UpdatePoseConsistency, HoldsWithAnUncertainPrior) {
  EXPECT_NEAR(mean_nees({0.2, 0.05, 0.03}, 200), 6.0, 0.81) << "seed " << kSeed;
}

TEST_F(UpdatePose, IsEmptyWithTooFewSightings) {
  observations_.resize(5);
  EXPECT_FALSE(update_pose(camera_, prior_, observations_));
  EXPECT_FALSE(update_pose(camera_, prior_, {}));
}

TEST_F(UpdatePose, IsEmptyWhereAllPointsCoincide) {
  prior_.information.setZero();
  prior_.T_world_camera = truth_;
  EXPECT_FALSE(update_pose(camera_, prior_, std::vector<PointObservation>(20, observations_[0])));
}

// The gate is 60 px and four standard deviations; the sightings agree with each other, and the prior knows nothing.
TEST_F(UpdatePose, LeavesOutWhatIsFartherOffThanTheLoosestGate) {
  prior_.T_world_camera = truth_;
  PoseUpdateOptions options;
  options.gate_chi2 = 1e3;
  for (PointObservation& o : observations_) o.pixel.x() += 62;
  EXPECT_TRUE(update_pose(camera_, prior_, observations_, options));
  for (PointObservation& o : observations_) o.pixel.x() += 4;
  EXPECT_FALSE(update_pose(camera_, prior_, observations_, options));
}

TEST_F(UpdatePose, LeavesOutWhatLiesBehindTheCamera) {
  PointObservation behind = observations_[0];
  behind.p_world = truth_ * Eigen::Vector3d(0, 0, -2);
  observations_.push_back(behind);
  const auto update = update_pose(camera_, prior_, observations_);
  ASSERT_TRUE(update);
  EXPECT_FALSE(update->is_inlier.back());
}

// A camera without distortion, the point on its axis 5 m away: a metre across is f/5 px, a metre along is nothing.
TEST(MeasurementNoise, AddsTheMapsToThePixels) {
  Camera camera = test::vga_camera();
  camera.distortion = BrownConrady{};
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3(Eigen::Vector3d(0, 0, std::acos(0.0)));  // camera x is world y
  PointObservation o;
  o.p_world = {0, 0, 5};
  o.sigma_px = 2;
  o.covariance_world = Eigen::Vector3d(0.01, 0.04, 100).asDiagonal();
  const auto noise = measurement_noise(camera, T, o, MapUncertainty::Inflated);
  ASSERT_TRUE(noise);
  EXPECT_NEAR((*noise)(0, 0), 4 + 104.0 * 104.0 * 0.04, 1e-6);
  EXPECT_NEAR((*noise)(1, 1), 4 + 103.0 * 103.0 * 0.01, 1e-6);
  EXPECT_NEAR((*noise)(0, 1), 0, 1e-9);
  EXPECT_LT((*measurement_noise(camera, T, o, MapUncertainty::Ignored) - 4 * Eigen::Matrix2d::Identity()).norm(), 1e-9);
  o.p_world.z() = -5;
  EXPECT_FALSE(measurement_noise(camera, T, o, MapUncertainty::Inflated));
}

}  // namespace
}  // namespace alidade
