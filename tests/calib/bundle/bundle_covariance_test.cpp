// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/bundle_covariance.h"

#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/calib/simulated_views.h"
#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

constexpr LensModel kLens = LensModel::Radial;

BundleFreedom free_lens() {
  BundleFreedom freedom;
  freedom.intrinsics = {free_intrinsics(kLens)};
  return freedom;
}

test::SimulatedBundle noisy_views(unsigned seed, int views = 10) {
  return test::simulate_bundle(test::simulated_camera(kLens), {.views = views, .noise_px = 0.2}, seed);
}

BundleFit fit_of(const test::SimulatedBundle& simulated) {
  return fit_bundle(simulated.truth, simulated.shape, simulated.views, free_lens());
}

BundleCovariance covariance_of(const test::SimulatedBundle& simulated) {
  return bundle_covariance(fit_of(simulated), simulated.shape, free_lens()).value();
}

// The normalised squared error of eight intrinsics is chi-squared of 8 degrees of freedom; the sum of 40 of them lies
// within 243 and 409 in 999 of 1000 cases.
TEST(BundleCovariance, IsThatOfTheIntrinsics) {
  double sum = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const auto simulated = noisy_views(seed);
    const BundleFit fit = fit_of(simulated);
    const auto covariance = bundle_covariance(fit, simulated.shape, free_lens());
    ASSERT_TRUE(covariance) << seed;
    const Eigen::VectorXd error =
        (intrinsics(fit.bundle.cameras[0].camera) - intrinsics(simulated.truth.cameras[0].camera)).head(8);
    const Eigen::MatrixXd C = covariance->shared_and_motion.topLeftCorner<8, 8>();
    sum += error.dot(C.llt().solve(error));
  }
  EXPECT_GT(sum, 243);
  EXPECT_LT(sum, 409);
}

// The boards' mean motion: what takes the true boards to the found ones, u + w × p, on average over the frames. The sum
// of 40 normalised squared errors of six lies within 174 and 319 in 999 of 1000 cases.
TEST(BundleCovariance, IsThatOfTheBoardsMeanMotion) {
  double sum = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const auto simulated = noisy_views(seed);
    const BundleFit fit = fit_of(simulated);
    const auto covariance = bundle_covariance(fit, simulated.shape, free_lens());
    ASSERT_TRUE(covariance) << seed;
    Vector6d motion = Vector6d::Zero();
    for (std::size_t f = 0; f < fit.bundle.T_rig_board.size(); ++f) {
      const Eigen::Isometry3d T = fit.bundle.T_rig_board[f] * simulated.truth.T_rig_board[f].inverse();
      motion.head<3>() += T.translation() / 10;
      motion.tail<3>() += log_so3(T.linear()) / 10;
    }
    const Matrix6d C = covariance->shared_and_motion.bottomRightCorner<6, 6>();
    sum += motion.dot(C.llt().solve(motion));
  }
  EXPECT_GT(sum, 174);
  EXPECT_LT(sum, 319);
}

TEST(BundleCovariance, MeasuresTheNoise) {
  const BundleCovariance covariance = covariance_of(noisy_views(3));
  EXPECT_NEAR(covariance.sigma, 2.0, 0.15);  // 0.2 px where the corners state 0.1; 1080 coordinates: +- 2 %
}

// Corners that state another sigma, all alike, change nothing.
TEST(BundleCovariance, DoesNotGoByWhatTheCornersState) {
  auto simulated = noisy_views(3);
  const Eigen::MatrixXd C = covariance_of(simulated).shared_and_motion;
  for (BundleView& view : simulated.views) {
    for (BoardCorner& corner : view.corners) corner.sigma_px = 0.02;
  }
  const Eigen::MatrixXd same = covariance_of(simulated).shared_and_motion;
  EXPECT_LT(((same - C).diagonal().array() / C.diagonal().array()).abs().maxCoeff(), 0.01);
}

// Each view four times over, as if taken four times with the same errors.
TEST(BundleCovariance, IsAQuarterForFourTimesTheViews) {
  const auto once = noisy_views(1);
  test::SimulatedBundle often{once.shape, {once.truth.cameras, {}, {}}, {}};
  for (int i = 0; i < 40; ++i) {
    often.views.push_back(once.views[static_cast<std::size_t>(i % 10)]);
    often.views.back().frame = i;
    often.truth.T_rig_board.push_back(once.truth.T_rig_board[static_cast<std::size_t>(i % 10)]);
  }
  const BundleLayout layout(once.truth, free_lens());
  const Eigen::VectorXd few = intrinsics_sigma(covariance_of(once), layout, 0);
  const Eigen::VectorXd many = intrinsics_sigma(covariance_of(often), layout, 0);
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(few[i] / many[i], 2.0, 0.05) << i;
}

// A frame of a rig that no camera saw is no measurement.
TEST(BundleCovariance, IsUnmovedByFramesThatNoViewShows) {
  const auto simulated = noisy_views(3);
  BundleFit fit = fit_of(simulated);
  const auto before = bundle_covariance(fit, simulated.shape, free_lens());
  fit.bundle.T_rig_board.insert(fit.bundle.T_rig_board.end(), 150, Eigen::Isometry3d::Identity());
  const auto after = bundle_covariance(fit, simulated.shape, free_lens());
  ASSERT_TRUE(before && after);
  EXPECT_EQ(after->sigma, before->sigma);
  EXPECT_LT((after->shared_and_motion - before->shared_and_motion).norm(), 1e-12 * before->shared_and_motion.norm());
}

// Errors of a view that go together: each view's corners are bent by a smooth field of its own (as by a bent board or
// blur), of the size of the noise.
TEST(BundleCovariance, GrowsWhereErrorsGoTogetherWithinViews) {
  int enlarged = 0;
  double least = 1e9;
  for (unsigned seed = 0; seed < 10; ++seed) {
    auto simulated = noisy_views(seed);
    test::RandomGeometry random(seed);
    for (BundleView& view : simulated.views) {
      Eigen::Matrix<double, 2, 3> bend;
      for (int i = 0; i < 3; ++i) bend.col(i) = random.vector(0.4).head<2>();
      for (BoardCorner& corner : view.corners) {
        const double u = (corner.id % 9 - 4) / 4.0, v = (corner.id / 9 - 2.5) / 2.5;
        corner.pixel += bend * Eigen::Vector3d(u * u, u * v, v * v);
      }
    }
    const double within = covariance_of(simulated).within_views;
    enlarged += within > 1;
    least = std::min(least, within);
  }
  EXPECT_GE(enlarged, 9);
  EXPECT_GE(least, 1);
}

// The jackknife's own scatter takes it above its threshold in 3 of 100 sets of 20 views (in 14 of 10 views).
TEST(BundleCovariance, StaysForIndependentNoise) {
  int enlarged = 0;
  for (unsigned seed = 0; seed < 30; ++seed) enlarged += covariance_of(noisy_views(seed, 20)).within_views > 1;
  EXPECT_LE(enlarged, 4);
}

TEST(BundleCovariance, IsEmptyWhereNothingIsSeen) {
  const auto simulated = noisy_views(3);
  BundleFit fit = fit_of(simulated);
  fit.views.clear();
  EXPECT_FALSE(bundle_covariance(fit, simulated.shape, free_lens()));
}

TEST(IntrinsicsCovariance, IsZeroWhereTheyWereHeld) {
  const auto simulated = noisy_views(3);
  BundleFreedom freedom;
  freedom.intrinsics = {{0, 5}};
  const BundleFit fit = fit_bundle(simulated.truth, simulated.shape, simulated.views, freedom);
  const auto covariance = bundle_covariance(fit, simulated.shape, freedom);
  ASSERT_TRUE(covariance);
  const BundleLayout layout(fit.bundle, freedom);
  const Eigen::VectorXd sigma = intrinsics_sigma(*covariance, layout, 0);
  const Eigen::MatrixXd C = intrinsics_covariance(*covariance, layout, fit.bundle.cameras[0].camera, 0);
  ASSERT_EQ(C.rows(), 12);
  EXPECT_NEAR(C(0, 0), sigma[0] * sigma[0], 1e-12);
  EXPECT_NEAR(C(5, 5), sigma[1] * sigma[1], 1e-12);
  EXPECT_EQ(C(0, 5), covariance->shared_and_motion(0, 1));
  EXPECT_EQ(C.row(1).norm(), 0);
  EXPECT_EQ(C.col(4).norm(), 0);
}

}  // namespace
}  // namespace alidade
