// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "calib/bundle/board_bundle.h"
#include "tests/calib/simulated_views.h"
#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

// A start some pixels from the truth.
BoardBundle disturbed(BoardBundle bundle, unsigned seed) {
  test::RandomGeometry random(seed);
  for (BundleCamera& of : bundle.cameras) {
    of.camera.fx *= 1.03;
    of.camera.fy *= 0.98;
    of.camera.cx += 6;
    of.camera.cy -= 5;
  }
  for (auto& T : bundle.T_rig_board) {
    Vector6d xi;
    xi << random.vector(0.005), random.vector(0.01);
    T = T * perturbation(xi);
  }
  return bundle;
}

BundleFreedom freedom_of(LensModel lens, bool warp) {
  BundleFreedom freedom;
  freedom.intrinsics = {free_intrinsics(lens)};
  freedom.warp = warp;
  return freedom;
}

TEST(SolveBundle, FindsTheTruthOfExactViews) {
  for (const LensModel lens : {LensModel::Radial, LensModel::Brown, LensModel::Rational, LensModel::Fisheye}) {
    test::Simulation exact{.sigma_px = 1e-4};
    exact.warp = {0.0004, -0.0003};
    const auto simulated = test::simulate_bundle(test::simulated_camera(lens), exact, 5);
    const auto solution =
        solve_bundle(disturbed(simulated.truth, 1), simulated.shape, simulated.views, freedom_of(lens, true));
    EXPECT_TRUE(solution.converged) << name_of(lens);
    const Camera& truth = simulated.truth.cameras[0].camera;
    EXPECT_LT(test::largest_difference_px(truth, solution.bundle.cameras[0].camera), 1e-6) << name_of(lens);
    EXPECT_NEAR(solution.bundle.warp.x_m, 0.0004, 1e-8) << name_of(lens);
    EXPECT_NEAR(solution.bundle.warp.y_m, -0.0003, 1e-8) << name_of(lens);
  }
}

// OpenCV's intrinsics of the same corners, from the same start; it takes pixels as float.
Camera calibrated_by_opencv(const test::SimulatedBundle& simulated, Camera camera, int flags) {
  std::vector<std::vector<cv::Point3f>> boards;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (const BundleView& view : simulated.views) {
    auto& board = boards.emplace_back();
    auto& pixel = pixels.emplace_back();
    for (const BoardCorner& corner : view.corners) {
      const Eigen::Vector3f p = simulated.shape.corners_m[static_cast<std::size_t>(corner.id)].cast<float>();
      board.emplace_back(p.x(), p.y(), p.z());
      pixel.emplace_back(static_cast<float>(corner.pixel.x()), static_cast<float>(corner.pixel.y()));
    }
  }
  cv::Mat K = (cv::Mat_<double>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::Mat k = cv::Mat::zeros(1, 5, CV_64F);
  std::vector<cv::Mat> rotations, translations;
  cv::calibrateCamera(boards, pixels, {camera.width, camera.height}, K, k, rotations, translations,
                      flags | cv::CALIB_USE_INTRINSIC_GUESS, {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 200, 0});
  Intrinsics values(12);
  values << K.at<double>(0, 0), K.at<double>(1, 1), K.at<double>(0, 2), K.at<double>(1, 2), k.at<double>(0),
      k.at<double>(1), k.at<double>(2), k.at<double>(3), k.at<double>(4), 0, 0, 0;
  return with_intrinsics(camera, values);
}

TEST(SolveBundle, HasTheOptimumOfOpenCv) {
  for (const LensModel lens : {LensModel::Radial, LensModel::Brown}) {
    const auto simulated = test::simulate_bundle(test::simulated_camera(lens), {.noise_px = 0.2, .sigma_px = 0.01}, 8);
    const BoardBundle start = disturbed(simulated.truth, 2);
    const auto solution = solve_bundle(start, simulated.shape, simulated.views, freedom_of(lens, false));
    const Camera& found = solution.bundle.cameras[0].camera;
    const Camera opencv =
        calibrated_by_opencv(simulated, start.cameras[0].camera, lens == LensModel::Radial ? cv::CALIB_FIX_K3 : 0);
    EXPECT_NEAR(found.fx, opencv.fx, 1e-3) << name_of(lens);
    EXPECT_NEAR(found.fy, opencv.fy, 1e-3) << name_of(lens);
    EXPECT_NEAR(found.cx, opencv.cx, 1e-3) << name_of(lens);
    EXPECT_NEAR(found.cy, opencv.cy, 1e-3) << name_of(lens);
    EXPECT_LT(test::largest_difference_px(opencv, found), 1e-3) << name_of(lens);
  }
}

TEST(SolveBundle, LetsStandWhatIsNotFree) {
  const auto simulated = test::simulate_bundle(test::simulated_camera(LensModel::Brown), {.noise_px = 0.1}, 3);
  BundleFreedom freedom;
  freedom.intrinsics = {{0, 4}};
  freedom.warp = false;
  const BoardBundle start = disturbed(simulated.truth, 4);
  const auto solution = solve_bundle(start, simulated.shape, simulated.views, freedom);
  const Intrinsics before = intrinsics(start.cameras[0].camera), after = intrinsics(solution.bundle.cameras[0].camera);
  for (int i = 0; i < before.size(); ++i) EXPECT_EQ(before[i] == after[i], i != 0 && i != 4) << i;
  EXPECT_EQ(solution.bundle.warp.x_m, 0);
}

TEST(SolveBundle, LetsCamerasStandWhereTheyAreHeld) {
  const Camera camera = test::simulated_camera(LensModel::Radial);
  std::vector<BundleCamera> cameras(2, {camera, Eigen::Isometry3d::Identity()});
  cameras[1].T_rig_camera.translation().x() = 0.05;
  const auto rig = test::simulate_rig(cameras, {{0, 1}, {0, 1}, {0, 1}}, {.noise_px = 0.1}, 3);
  std::vector<BundleView> views;
  for (int c = 0; c < 2; ++c) {
    for (const BoardView& view : rig.cameras[static_cast<std::size_t>(c)].views) {
      views.push_back({c, view.frame, view.corners, std::vector<double>(view.corners.size(), 1.0)});
    }
  }
  BundleFreedom freedom;
  const BoardBundle start = disturbed({cameras, rig.T_rig_board, {}}, 2);
  const auto moved_of = [&](const BundleSolution& solution) {
    return difference(start.cameras[1].T_rig_camera, solution.bundle.cameras[1].T_rig_camera).norm();
  };
  const BoardShape shape = shape_of(test::simulated_board());
  EXPECT_GT(moved_of(solve_bundle(start, shape, views, freedom)), 1e-6);
  freedom.camera_poses = false;
  EXPECT_EQ(moved_of(solve_bundle(start, shape, views, freedom)), 0);
}

TEST(SolveBundle, IgnoresCornersWithoutWeight) {
  auto simulated = test::simulate_bundle(test::simulated_camera(LensModel::Radial), {.sigma_px = 1e-4}, 3);
  simulated.views[2].corners[10].pixel += Eigen::Vector2d(30, -20);
  simulated.views[2].weights[10] = 0;
  const auto solution = solve_bundle(disturbed(simulated.truth, 4), simulated.shape, simulated.views,
                                     freedom_of(LensModel::Radial, true));
  const Camera& truth = simulated.truth.cameras[0].camera;
  EXPECT_LT(test::largest_difference_px(truth, solution.bundle.cameras[0].camera), 1e-6);
}

TEST(SolveBundle, LeavesAFrameThatNoViewShows) {
  auto simulated = test::simulate_bundle(test::simulated_camera(LensModel::Radial), {.noise_px = 0.1}, 3);
  const auto freedom = freedom_of(LensModel::Radial, true);
  const BoardBundle start = disturbed(simulated.truth, 4);
  const auto without = solve_bundle(start, simulated.shape, simulated.views, freedom);
  BoardBundle longer = start;
  longer.T_rig_board.emplace_back(Eigen::Translation3d(1, 2, 3));
  const auto with = solve_bundle(longer, simulated.shape, simulated.views, freedom);
  EXPECT_EQ(with.bundle.T_rig_board.back().translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(with.bundle.cameras[0].camera, without.bundle.cameras[0].camera);
}

TEST(SolveBundle, EndsWhereNoStepIsLeft) {
  const auto simulated = test::simulate_bundle(test::simulated_camera(LensModel::Radial), {.noise_px = 0.1}, 3);
  const auto freedom = freedom_of(LensModel::Radial, true);
  const BoardBundle start = disturbed(simulated.truth, 4);
  const auto solution = solve_bundle(start, simulated.shape, simulated.views, freedom);
  EXPECT_NEAR(solution.cost, bundle_cost(solution.bundle, simulated.shape, simulated.views, freedom),
              1e-9 * solution.cost);
  EXPECT_LT(solution.cost, bundle_cost(simulated.truth, simulated.shape, simulated.views, freedom));
  EXPECT_EQ(solve_bundle(solution.bundle, simulated.shape, simulated.views, freedom).iterations, 0);
  const auto cut_short = solve_bundle(start, simulated.shape, simulated.views, freedom, {2});
  EXPECT_FALSE(cut_short.converged);
  EXPECT_EQ(cut_short.iterations, 2);
}

TEST(SolveBundle, GivesTheSameTwice) {
  const auto simulated = test::simulate_bundle(test::simulated_camera(LensModel::Brown), {.noise_px = 0.1}, 3);
  const auto freedom = freedom_of(LensModel::Brown, true);
  const auto first = solve_bundle(simulated.truth, simulated.shape, simulated.views, freedom);
  const auto second = solve_bundle(simulated.truth, simulated.shape, simulated.views, freedom);
  EXPECT_EQ(first.bundle.cameras[0].camera, second.bundle.cameras[0].camera);
  EXPECT_EQ(first.cost, second.cost);
}

}  // namespace
}  // namespace alidade
