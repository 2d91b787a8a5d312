// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/board_bundle.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "calib/bundle/bundle_priors.h"
#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

// A rational lens and a fisheye 0.1 m apart that see three boards, with noise and unequal weights and sigmas.
struct Scene {
  BoardShape shape = shape_of(test::simulated_board());
  BoardBundle bundle;
  std::vector<BundleView> views;
  BundleFreedom freedom;
};

Scene make_scene() {
  Scene scene;
  Eigen::Isometry3d T_rig_camera =
      Eigen::Isometry3d(Eigen::AngleAxisd(-0.2, Eigen::Vector3d(0.1, 1, 0.2).normalized()));
  T_rig_camera.translation() << 0.1, 0.01, -0.02;
  scene.bundle.cameras = {{test::simulated_camera(LensModel::Rational), Eigen::Isometry3d::Identity()},
                          {test::simulated_camera(LensModel::Fisheye), T_rig_camera}};
  const auto rig = test::simulate_rig(scene.bundle.cameras, {{0, 1}, {0}, {0, 1}}, {.noise_px = 0.5}, 3);
  scene.bundle.T_rig_board = rig.T_rig_board;
  scene.bundle.warp = {0.0003, -0.0002};
  for (int c = 0; c < 2; ++c) {
    for (const BoardView& view : rig.cameras[static_cast<std::size_t>(c)].views) {
      BundleView added{c, view.frame, view.corners, std::vector<double>(view.corners.size(), 1.0)};
      for (std::size_t i = 0; i < added.weights.size(); ++i) {
        added.weights[i] = 0.1 * static_cast<double>(i % 8);  // the first of eight counts for nothing
        added.corners[i].sigma_px = 0.1 + 0.02 * static_cast<double>(i % 5);
      }
      scene.views.push_back(std::move(added));
    }
  }
  scene.freedom.intrinsics = {free_intrinsics(LensModel::Rational), free_intrinsics(LensModel::Fisheye)};
  return scene;
}

// The bundle moved by x: the shared parameters in the layout's order, then six of every frame.
BoardBundle moved(BoardBundle bundle, const BundleFreedom& freedom, const Eigen::VectorXd& x) {
  const BundleLayout layout(bundle, freedom);
  for (int c = 0; c < static_cast<int>(bundle.cameras.size()); ++c) {
    BundleCamera& of = bundle.cameras[static_cast<std::size_t>(c)];
    Intrinsics values = intrinsics(of.camera);
    for (int i = layout.intrinsics_at(c); const int place : layout.free_of(c)) values[place] += x[i++];
    of.camera = with_intrinsics(of.camera, values);
    if (layout.camera_poses && c > 0) of.T_rig_camera = of.T_rig_camera * perturbation(x.segment<6>(layout.pose_at(c)));
  }
  if (layout.warp) {
    bundle.warp.x_m += x[layout.warp_at];
    bundle.warp.y_m += x[layout.warp_at + 1];
  }
  for (int at = layout.size; auto& T : bundle.T_rig_board) {
    T = T * perturbation(x.segment<6>(at));
    at += 6;
  }
  return bundle;
}

// All of the equations in one matrix and vector, without the priors.
struct DenseEquations {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
};

DenseEquations dense(const Scene& scene) {
  const BundleEquations e = bundle_equations(scene.bundle, scene.shape, scene.views, scene.freedom);
  const Eigen::Index n = e.g.size(), all = n + 6 * static_cast<Eigen::Index>(e.g_frame.size());
  DenseEquations d{Eigen::MatrixXd::Zero(all, all), Eigen::VectorXd::Zero(all)};
  d.H.topLeftCorner(n, n) = e.H;
  d.g.head(n) = e.g;
  for (Eigen::Index f = 0; f < static_cast<Eigen::Index>(e.g_frame.size()); ++f) {
    const auto i = static_cast<std::size_t>(f);
    d.H.block(n + 6 * f, n + 6 * f, 6, 6) = e.H_frame[i];
    d.H.block(n + 6 * f, 0, 6, n) = e.H_frame_shared[i];
    d.H.block(0, n + 6 * f, n, 6) = e.H_frame_shared[i].transpose();
    d.g.segment<6>(n + 6 * f) = e.g_frame[i];
  }
  for (const BundlePrior& prior : bundle_priors(scene.bundle, scene.shape, scene.freedom)) {
    d.H(prior.place, prior.place) -= prior.information;
    d.g[prior.place] -= prior.information * prior.value;
  }
  return d;
}

double cost_without_priors(const Scene& scene, const BoardBundle& bundle) {
  double cost = bundle_cost(bundle, scene.shape, scene.views, scene.freedom);
  for (const BundlePrior& prior : bundle_priors(bundle, scene.shape, scene.freedom)) {
    cost -= prior.information * prior.value * prior.value;
  }
  return cost;
}

// All residuals in units of their sigma, times the root of their weight.
Eigen::VectorXd weighted_residuals(const Scene& scene, const BoardBundle& bundle) {
  std::vector<double> values;
  for (const BundleView& view : scene.views) {
    const auto residuals = residuals_px(bundle, scene.shape, view);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      const double scale = std::sqrt(view.weights[i]) / view.corners[i].sigma_px;
      values.insert(values.end(), {scale * residuals[i].x(), scale * residuals[i].y()});
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Steps that move pixels by about 1e-3 px: of intrinsics, poses and warp.
Eigen::VectorXd steps(const Scene& scene, Eigen::Index size) {
  Eigen::VectorXd h = Eigen::VectorXd::Constant(size, 1e-6);
  const BundleLayout layout(scene.bundle, scene.freedom);
  for (int c = 0; c < 2; ++c) h.segment<4>(layout.intrinsics_at(c)).setConstant(1e-3);
  return h;
}

TEST(BundleEquations, HaveTheGradientOfTheCost) {
  const Scene scene = make_scene();
  const DenseEquations e = dense(scene);
  const Eigen::VectorXd h = steps(scene, e.g.size());
  for (Eigen::Index i = 0; i < e.g.size(); ++i) {
    const Eigen::VectorXd x = h[i] * Eigen::VectorXd::Unit(e.g.size(), i);
    const double slope = (cost_without_priors(scene, moved(scene.bundle, scene.freedom, x)) -
                          cost_without_priors(scene, moved(scene.bundle, scene.freedom, -x))) /
                         (2 * h[i]);
    // g is half of it; its own scale is the root of what the cost is made of.
    EXPECT_NEAR(e.g[i], 0.5 * slope, 1e-5 * (std::abs(e.g[i]) + std::sqrt(e.H(i, i)))) << i;
  }
}

TEST(BundleEquations, HaveTheHessianOfGaussAndNewton) {
  const Scene scene = make_scene();
  const DenseEquations e = dense(scene);
  const Eigen::VectorXd h = steps(scene, e.g.size());
  Eigen::MatrixXd J(weighted_residuals(scene, scene.bundle).size(), e.g.size());
  for (Eigen::Index i = 0; i < e.g.size(); ++i) {
    const Eigen::VectorXd x = h[i] * Eigen::VectorXd::Unit(e.g.size(), i);
    J.col(i) = (weighted_residuals(scene, moved(scene.bundle, scene.freedom, x)) -
                weighted_residuals(scene, moved(scene.bundle, scene.freedom, -x))) /
               (2 * h[i]);
  }
  const Eigen::MatrixXd expected = J.transpose() * J;
  const Eigen::VectorXd scale = expected.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd error = scale.asDiagonal() * (e.H - expected) * scale.asDiagonal();
  EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-6);
}

TEST(BundleEquations, NameTheCostThatBundleCostNames) {
  const Scene scene = make_scene();
  const double cost = bundle_cost(scene.bundle, scene.shape, scene.views, scene.freedom);
  EXPECT_NEAR(bundle_equations(scene.bundle, scene.shape, scene.views, scene.freedom).cost, cost, 1e-9 * cost);
  EXPECT_NEAR(cost_without_priors(scene, scene.bundle), weighted_residuals(scene, scene.bundle).squaredNorm(),
              1e-9 * cost);
}

TEST(BundleEquations, OfNoViewsAreThePriors) {
  const Scene scene = make_scene();
  const BundleEquations e = bundle_equations(scene.bundle, scene.shape, {}, scene.freedom);
  for (const BundlePrior& prior : bundle_priors(scene.bundle, scene.shape, scene.freedom)) {
    EXPECT_EQ(e.H(prior.place, prior.place), prior.information);
  }
  EXPECT_EQ(e.H(0, 0), 0);  // of the focal length nothing is believed
  EXPECT_EQ(e.H_frame[1].norm(), 0);
}

TEST(BundleEquations, RefuseViewsOfWhatDoesNotExist) {
  const auto try_with = [](auto change) {
    Scene scene = make_scene();
    change(scene.views.front());
    bundle_equations(scene.bundle, scene.shape, scene.views, scene.freedom);
  };
  EXPECT_NO_THROW(try_with([](BundleView&) {}));
  EXPECT_THROW(try_with([](BundleView& v) { v.camera = 2; }), std::invalid_argument);
  EXPECT_THROW(try_with([](BundleView& v) { v.camera = -1; }), std::invalid_argument);
  EXPECT_THROW(try_with([](BundleView& v) { v.frame = 3; }), std::invalid_argument);
  EXPECT_THROW(try_with([](BundleView& v) { v.corners[5].id = 54; }), std::invalid_argument);
  EXPECT_THROW(try_with([](BundleView& v) { v.corners[5].id = -1; }), std::invalid_argument);
  EXPECT_THROW(try_with([](BundleView& v) { v.weights.pop_back(); }), std::invalid_argument);
}

TEST(BundleLayout, HoldsWhatIsFreeOnly) {
  const Scene scene = make_scene();
  const BundleLayout all(scene.bundle, scene.freedom);
  EXPECT_EQ(all.intrinsics_at(1), 12);
  EXPECT_EQ(all.pose_at(1), 20);
  EXPECT_EQ(all.warp_at, 26);
  EXPECT_EQ(all.size, 28);
  BundleFreedom few;
  few.intrinsics = {{}};  // the second camera is left out
  EXPECT_EQ(BundleLayout(scene.bundle, few).size, 8);
  few.warp = false;
  EXPECT_EQ(BundleLayout(scene.bundle, few).size, 6);
  few.camera_poses = false;
  EXPECT_EQ(BundleLayout(scene.bundle, few).size, 0);
}

TEST(Residuals, AreFoundMinusSeen) {
  auto exact = test::simulate_bundle(test::simulated_camera(LensModel::Brown), {.views = 1}, 1);
  exact.views[0].corners[7].pixel += Eigen::Vector2d(2, -3);
  const auto residuals = residuals_px(exact.truth, exact.shape, exact.views[0]);
  EXPECT_LT(residuals[6].norm(), 1e-9);
  EXPECT_LT((residuals[7] - Eigen::Vector2d(-2, 3)).norm(), 1e-9);
}

TEST(Residuals, AreAThousandPixelsBehindTheCamera) {
  auto exact = test::simulate_bundle(test::simulated_camera(LensModel::Brown), {.views = 1}, 1);
  exact.truth.T_rig_board[0].translation().z() *= -1;
  EXPECT_EQ(residuals_px(exact.truth, exact.shape, exact.views[0])[0], Eigen::Vector2d(1000, 1000));
}

// 9x6 corners, 25 mm apart: half extents of 100 and 62.5 mm, so that corner (2, 1) lies at u = -1/2, v = -3/5.
TEST(BoardShape, BulgesAsAParabolaThatIsZeroAtTheCorners) {
  const BoardShape shape = shape_of(test::simulated_board());
  EXPECT_NEAR(shape.extent_m, std::hypot(0.2, 0.125), 1e-12);
  EXPECT_NEAR(shape.bulge[11].x(), 0.75, 1e-12);
  EXPECT_NEAR(shape.bulge[11].y(), 0.64, 1e-12);
  const BoardWarp warp{0.001, 0.002};
  EXPECT_LT((shape.corner(11, warp) - Eigen::Vector3d(0.05, 0.025, 0.75e-3 + 1.28e-3)).norm(), 1e-12);
  for (const int id : {0, 8, 45, 53}) EXPECT_NEAR(shape.corner(id, warp).z(), 0, 1e-12) << id;
}

}  // namespace
}  // namespace alidade
