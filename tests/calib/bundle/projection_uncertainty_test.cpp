// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/projection_uncertainty.h"

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

const Eigen::Vector2d kCentre(320, 240), kEdge(40, 240);

// A fit to noisy views of the radial lens.
struct Fitted {
  test::SimulatedBundle simulated;
  BundleFreedom freedom;
  BundleFit fit;
  BundleCovariance covariance;
};

Fitted fit_views(unsigned seed) {
  Fitted f{test::simulate_bundle(test::simulated_camera(LensModel::Radial), {.noise_px = 0.2}, seed), {}, {}, {}};
  f.freedom.intrinsics = {free_intrinsics(LensModel::Radial)};
  f.fit = fit_bundle(f.simulated.truth, f.simulated.shape, f.simulated.views, f.freedom);
  f.covariance = bundle_covariance(f.fit, f.simulated.shape, f.freedom).value();
  return f;
}

// Where the fit images what truly is at `pixel`: the point is carried by the boards, from where they stood to where
// they were found.
Eigen::Vector2d found_at(const Fitted& f, const Eigen::Vector2d& pixel, double distance_m) {
  const Eigen::Vector3d p = distance_m * *unproject(f.simulated.truth.cameras[0].camera, pixel);
  Eigen::Vector3d carried = Eigen::Vector3d::Zero();
  const std::size_t frames = f.fit.bundle.T_rig_board.size();
  for (std::size_t i = 0; i < frames; ++i) {
    carried += f.fit.bundle.T_rig_board[i] * (f.simulated.truth.T_rig_board[i].inverse() * p);
  }
  return project(f.fit.bundle.cameras[0].camera, carried / static_cast<double>(frames))->pixel;
}

// 90 % of the true pixels lie where chi-squared of 2 degrees of freedom is below 4.605. Of 60 trials 54 +- 2.3 do; 46
// or fewer in one of a thousand cases.
TEST(PixelCovariance, CoversTheTruthAsOftenAsItSays) {
  const std::array<Eigen::Vector2d, 3> places{kCentre, kEdge, Eigen::Vector2d(30, 30)};
  std::array<int, 3> covered{};
  std::array<double, 3> nees{};
  for (unsigned seed = 100; seed < 160; ++seed) {
    const Fitted f = fit_views(seed);
    const double distance_m = median_distance_m(f.fit, f.simulated.shape, 0);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto C = pixel_covariance(f.covariance, f.fit.bundle, f.freedom, 0, places[i], distance_m);
      ASSERT_TRUE(C) << seed;
      const Eigen::Vector2d error = found_at(f, places[i], distance_m) - places[i];
      nees[i] += error.dot(C->inverse() * error);
      covered[i] += error.dot(C->inverse() * error) < 4.605;
    }
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_GT(covered[i], 46) << places[i].transpose();
    // The sum of 60 of two degrees of freedom: 999 of 1000 lie between 75 and 178.
    EXPECT_GT(nees[i], 75) << places[i].transpose();
    EXPECT_LT(nees[i], 178) << places[i].transpose();
  }
}

// Two cameras with all of them free, the second one a fisheye.
struct Pair {
  BoardBundle bundle;
  BundleFreedom freedom;
};

Pair make_pair_of_cameras() {
  Pair pair;
  Eigen::Isometry3d T_rig_camera =
      Eigen::Isometry3d(Eigen::AngleAxisd(-0.3, Eigen::Vector3d(0.1, 1, 0.2).normalized()));
  T_rig_camera.translation() << 0.2, 0.01, -0.02;
  pair.bundle.cameras = {{test::simulated_camera(LensModel::Rational), Eigen::Isometry3d::Identity()},
                         {test::simulated_camera(LensModel::Fisheye), T_rig_camera}};
  pair.freedom.intrinsics = {free_intrinsics(LensModel::Rational), free_intrinsics(LensModel::Fisheye)};
  return pair;
}

// The pixel of a point that is fixed in the rig but for the boards' motion.
Eigen::Vector2d pixel_after(const Pair& pair, int index, const Eigen::Vector3d& p_rig, const Eigen::VectorXd& x) {
  const BundleLayout layout(pair.bundle, pair.freedom);
  const BundleCamera& of = pair.bundle.cameras[static_cast<std::size_t>(index)];
  Intrinsics values = intrinsics(of.camera);
  for (int i = layout.intrinsics_at(index); const int place : layout.free_of(index)) values[place] += x[i++];
  Eigen::Isometry3d T_rig_camera = of.T_rig_camera;
  if (index > 0) T_rig_camera = T_rig_camera * perturbation(x.segment<6>(layout.pose_at(index)));
  const Eigen::Vector3d moved = p_rig + x.segment<3>(layout.size) + x.tail<3>().cross(p_rig);
  return project(with_intrinsics(of.camera, values), T_rig_camera.inverse() * moved)->pixel;
}

TEST(PixelJacobian, IsThatOfCentralDifferences) {
  const Pair pair = make_pair_of_cameras();
  for (const int index : {0, 1}) {
    const BundleCamera& of = pair.bundle.cameras[static_cast<std::size_t>(index)];
    const Eigen::Vector2d pixel(100, 350);
    const auto J = pixel_jacobian(pair.bundle, pair.freedom, index, pixel, 0.7);
    ASSERT_TRUE(J);
    const Eigen::Vector3d p_rig = of.T_rig_camera * (0.7 * *unproject(of.camera, pixel));
    ASSERT_EQ(J->cols(), BundleLayout(pair.bundle, pair.freedom).size + 6);
    for (Eigen::Index i = 0; i < J->cols(); ++i) {
      const Eigen::VectorXd x = 1e-5 * Eigen::VectorXd::Unit(J->cols(), i);
      const Eigen::Vector2d slope = (pixel_after(pair, index, p_rig, x) - pixel_after(pair, index, p_rig, -x)) / 2e-5;
      EXPECT_LT((J->col(i) - slope).norm(), 1e-5 * (1 + slope.norm())) << index << " " << i;
    }
  }
}

TEST(PixelJacobian, IsEmptyWhereTheLensHasNoDirection) {
  Pair pair = make_pair_of_cameras();
  pair.bundle.cameras[0].camera.distortion = BrownConrady{-0.9};  // folds at 0.41 focal lengths off the centre
  EXPECT_TRUE(pixel_jacobian(pair.bundle, pair.freedom, 0, kCentre, 1.0));
  EXPECT_FALSE(pixel_jacobian(pair.bundle, pair.freedom, 0, {5, 5}, 1.0));
  BundleCovariance covariance;
  covariance.shared_and_motion = Eigen::MatrixXd::Identity(34, 34);
  EXPECT_FALSE(pixel_covariance(covariance, pair.bundle, pair.freedom, 0, {5, 5}, 1.0));
}

// Boards at 1, 2 and 3 m before the first camera; the second one, 1 m behind it, saw the last two. Two frames were seen
// by none, and one only by corners that were cut.
TEST(MedianDistance, IsOfTheBoardsThatTheCameraSaw) {
  const BoardShape shape = shape_of(test::simulated_board());
  const Eigen::Vector3d centre(0.1, 0.0625, 0);
  BundleFit fit;
  fit.bundle.cameras.resize(2);
  fit.bundle.cameras[1].T_rig_camera.translation().z() = -1;
  for (const double z : {1.0, 2.0, 3.0, 9.0, 0.0, 0.0}) {
    fit.bundle.T_rig_board.emplace_back(Eigen::Translation3d(z * Eigen::Vector3d::UnitZ() - centre));
  }
  for (int frame = 0; frame < 4; ++frame) {
    const double weight = frame < 3 ? 1 : 0;
    fit.views.push_back({0, frame, {{0, {1, 1}, 0.1}}, {weight}});
    if (frame > 0) fit.views.push_back({1, frame, {{0, {1, 1}, 0.1}}, {weight}});
  }
  EXPECT_NEAR(median_distance_m(fit, shape, 0), 2, 1e-12);
  EXPECT_NEAR(median_distance_m(fit, shape, 1), 4, 1e-12);  // the upper one of two
  fit.views.clear();
  EXPECT_EQ(median_distance_m(fit, shape, 0), 1);
}

TEST(PixelJacobians, AreTakenWhereBoardsWereSeen) {
  const Fitted f = fit_views(1);
  BundleFit longer = f.fit;
  longer.bundle.T_rig_board.insert(longer.bundle.T_rig_board.end(), 50, Eigen::Isometry3d::Identity());
  const auto all = pixel_jacobians(f.fit, f.freedom), same = pixel_jacobians(longer, f.freedom);
  ASSERT_EQ(all.size(), 25U);
  ASSERT_EQ(same.size(), 25U);
  for (std::size_t i = 0; i < 25; ++i) EXPECT_EQ(all[i], same[i]) << i;
}

TEST(UncertaintyMap, GoesOverTheImageFromItsFirstPixel) {
  Fitted f = fit_views(1);
  const UncertaintyMap map = uncertainty_map(f.covariance, f.fit.bundle, f.freedom, 0, 0.4, 8);
  EXPECT_EQ(map.columns, 8);
  EXPECT_NEAR(map.step_px, 639.0 / 7, 1e-12);
  EXPECT_EQ(map.rows, 6);  // 5 steps of 91 px fit into 479
  ASSERT_EQ(map.sigma_px.size(), 48U);
  const auto C = pixel_covariance(f.covariance, f.fit.bundle, f.freedom, 0, map.step_px * Eigen::Vector2d(3, 2), 0.4);
  const double larger = 0.5 * (C->trace() + std::sqrt(C->trace() * C->trace() - 4 * C->determinant()));
  EXPECT_NEAR(map.sigma_px[2 * 8 + 3], std::sqrt(larger), 1e-9);
  EXPECT_GT(map.sigma_px[0], 2 * map.sigma_px[2 * 8 + 3]);  // the corner is seen least
}

TEST(UncertaintyMap, HasNoNumberWhereTheLensHasNoDirection) {
  Fitted f = fit_views(1);
  f.fit.bundle.cameras[0].camera.distortion = BrownConrady{-0.9};
  const UncertaintyMap map = uncertainty_map(f.covariance, f.fit.bundle, f.freedom, 0, 0.4, 8);
  EXPECT_TRUE(std::isnan(map.sigma_px[0]));
  EXPECT_TRUE(std::isfinite(map.sigma_px[2 * 8 + 3]));
}

}  // namespace
}  // namespace alidade
