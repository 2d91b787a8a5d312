// SPDX-License-Identifier: Apache-2.0
#include "calib/rigs/rig_calibration.h"

#include <algorithm>
#include <cmath>
#include <stop_token>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "tests/calib/simulated_views.h"
#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

using Outcome = RigCalibrationOutcome;

CameraCalibrationOptions radial() {
  CameraCalibrationOptions options;
  options.lens = LensModel::Radial;
  options.folds = 2;  // for speed: nothing here asks for the held-out error
  return options;
}

// Three cameras in a row, each turned outwards a little.
std::vector<BundleCamera> three_cameras() {
  std::vector<BundleCamera> cameras(3);
  for (int i = 0; i < 3; ++i) {
    BundleCamera& of = cameras[static_cast<std::size_t>(i)];
    of.camera = test::simulated_camera(LensModel::Radial);
    of.camera.fx += 10 * i;
    of.T_rig_camera = Eigen::Isometry3d(Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitY()));
    of.T_rig_camera.translation() << 0.08 * i, 0.003 * i, -0.005 * i;
  }
  return cameras;
}

// 0 and 1, and 1 and 2 look at once, 0 and 2 never.
std::vector<std::vector<int>> chained_moments(int count) {
  std::vector<std::vector<int>> moments;
  for (int i = 0; i < count; ++i) moments.push_back(i % 2 == 0 ? std::vector{0, 1} : std::vector{1, 2});
  return moments;
}

test::SimulatedRig chained_rig(double noise_px, unsigned seed) {
  return test::simulate_rig(three_cameras(), chained_moments(16), {.noise_px = noise_px}, seed);
}

RigCalibration calibrate(const test::SimulatedRig& rig, const CameraCalibrationOptions& options = radial()) {
  return calibrate_rig(test::simulated_board(), rig.cameras, options);
}

TEST(CalibrateRig, FindsAChainFromExactViews) {
  auto rig = chained_rig(0.0, 3);
  for (RigCameraViews& camera : rig.cameras) {
    for (BoardView& view : camera.views) {
      for (BoardCorner& corner : view.corners) corner.sigma_px = 1e-4;
    }
  }
  CameraCalibrationOptions options = radial();
  options.fit.least_sigma_px = 0;
  const RigCalibration found = calibrate_rig(test::simulated_board(), rig.cameras, options);
  ASSERT_EQ(found.outcome, Outcome::Calibrated) << explain(found, rig.cameras);
  const auto cameras = three_cameras();
  for (std::size_t i = 0; i < 3; ++i) {
    const BundleCamera& of = found.fit.bundle.cameras[i];
    EXPECT_LT(test::largest_difference_px(cameras[i].camera, of.camera), 1e-6) << i;
    EXPECT_LT(difference(cameras[i].T_rig_camera, of.T_rig_camera).norm(), 1e-8) << i;
  }
  EXPECT_EQ(explain(found, rig.cameras), "");
  EXPECT_LT(found.rms_all_px, 1e-6);
}

// All baselines of eight rigs lie within 4 sigmas; the normalised squared errors of eight poses add up to 22 .. 87 in
// 999 of 1000 cases (chi-squared of 48 degrees of freedom).
TEST(CalibrateRig, StatesHowSureItIsOfThePoses) {
  const auto cameras = three_cameras();
  double nees = 0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    const auto rig = chained_rig(0.2, seed);
    const RigCalibration found = calibrate(rig);
    ASSERT_EQ(found.outcome, Outcome::Calibrated) << seed << ": " << explain(found, rig.cameras);
    ASSERT_EQ(found.pairs.size(), 2U);
    for (const PairError& pair : found.pairs) {
      const auto first = static_cast<std::size_t>(pair.first), second = static_cast<std::size_t>(pair.second);
      const double truth =
          (cameras[first].T_rig_camera.translation() - cameras[second].T_rig_camera.translation()).norm();
      EXPECT_LT(std::abs(pair.baseline_m - truth), 4 * pair.baseline_sigma_m) << seed;
      EXPECT_LT(pair.baseline_sigma_m, 0.002) << seed;
    }
    const Vector6d error = difference(found.fit.bundle.cameras[1].T_rig_camera, cameras[1].T_rig_camera);
    nees += error.dot(camera_pose_covariance(found, 1).llt().solve(error));
  }
  EXPECT_GT(nees, 22);
  EXPECT_LT(nees, 87);
}

TEST(CalibrateRig, NamesThePairsThatLookAtOnce) {
  const RigCalibration found = calibrate(chained_rig(0.1, 2));
  ASSERT_EQ(found.pairs.size(), 2U);
  EXPECT_EQ(found.pairs[0].first, 0);
  EXPECT_EQ(found.pairs[0].second, 1);
  EXPECT_EQ(found.pairs[1].first, 1);
  EXPECT_EQ(found.pairs[1].second, 2);
  for (const PairError& pair : found.pairs) {
    EXPECT_GE(pair.corners, 8 * 54 - 3);                            // one in some thousand is cut
    EXPECT_NEAR(pair.epipolar_rms_px, 0.1 * std::sqrt(2.0), 0.03);  // of two corners, across the line
  }
  ASSERT_EQ(found.camera_rms_px.size(), 3U);
  for (const double rms : found.camera_rms_px) EXPECT_NEAR(rms, 0.1 * std::sqrt(2.0), 0.02);
  EXPECT_EQ(found.residuals.size(), 3U);
}

TEST(CalibrateRig, MixesLenses) {
  auto cameras = three_cameras();
  cameras.resize(2);
  cameras[1].camera = test::simulated_camera(LensModel::Fisheye);
  const std::vector<std::vector<int>> together(14, {0, 1});
  const auto rig = test::simulate_rig(cameras, together, {.noise_px = 0.03}, 5);
  const RigCalibration found = calibrate(rig, {});
  ASSERT_EQ(found.outcome, Outcome::Calibrated) << explain(found, rig.cameras);
  EXPECT_TRUE(std::holds_alternative<BrownConrady>(found.fit.bundle.cameras[0].camera.distortion));
  EXPECT_TRUE(std::holds_alternative<Fisheye>(found.fit.bundle.cameras[1].camera.distortion));
  EXPECT_LT(difference(cameras[1].T_rig_camera, found.fit.bundle.cameras[1].T_rig_camera).norm(), 0.005);
}

// Moments are numbered as images, most of which do not show the board.
TEST(CalibrateRig, DoesNotCountMomentsThatNobodySaw) {
  auto rig = chained_rig(0.2, 4);
  const RigCalibration dense = calibrate(rig);
  for (RigCameraViews& camera : rig.cameras) {
    for (BoardView& view : camera.views) view.frame = 20 * view.frame + 7;
  }
  const RigCalibration sparse = calibrate(rig);
  ASSERT_EQ(sparse.outcome, Outcome::Calibrated);
  EXPECT_NEAR(sparse.covariance.sigma, dense.covariance.sigma, 1e-9);
  EXPECT_EQ(sparse.covariance.within_views > 1, dense.covariance.within_views > 1);
  EXPECT_NEAR(sparse.pairs[0].baseline_sigma_m, dense.pairs[0].baseline_sigma_m, 1e-9);
}

TEST(CalibrateRig, CutsAViewOfAnotherMoment) {
  auto rig = chained_rig(0.1, 6);
  rig.cameras[2].views[3].corners = rig.cameras[2].views[5].corners;  // the camera missed a trigger
  const RigCalibration found = calibrate(rig);
  ASSERT_EQ(found.outcome, Outcome::Calibrated) << explain(found, rig.cameras);
  const auto cameras = three_cameras();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(difference(cameras[i].T_rig_camera, found.fit.bundle.cameras[i].T_rig_camera).norm(), 0.01) << i;
  }
}

// A camera that takes two images of what it has seen: the board was moved in between, before the other one.
TEST(CalibrateRig, PlacesNoBoardByARepeatOfARejectedView) {
  auto rig = chained_rig(0.1, 6);
  test::RandomGeometry random(2);
  auto& views = rig.cameras[0].views;
  for (BoardCorner& corner : views[2].corners) corner.pixel += random.vector(20).head<2>();
  views[5].corners = views[2].corners;
  const RigCalibration found = calibrate(rig);
  ASSERT_EQ(found.outcome, Outcome::Calibrated) << explain(found, rig.cameras);
  EXPECT_EQ(found.alone[0].verdicts[2].use, ViewUse::Rejected);
  EXPECT_EQ(found.alone[0].verdicts[5].use, ViewUse::Repeated);
  const auto cameras = three_cameras();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(difference(cameras[i].T_rig_camera, found.fit.bundle.cameras[i].T_rig_camera).norm(), 0.01) << i;
  }
  // The second camera saw the board at that moment: all of its corners count.
  for (const BundleView& view : found.fit.views) {
    if (view.camera != 1 || view.frame != views[5].frame) continue;
    EXPECT_LE(std::count(view.weights.begin(), view.weights.end(), 0.0), 1);
  }
}

TEST(CalibrateRig, GivesTheSameTwice) {
  const auto rig = chained_rig(0.1, 2);
  const RigCalibration first = calibrate(rig), second = calibrate(rig);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(first.fit.bundle.cameras[i].camera, second.fit.bundle.cameras[i].camera) << i;
  }
  EXPECT_EQ(first.covariance.shared_and_motion, second.covariance.shared_and_motion);
}

TEST(ExplainRig, NamesTheCameraThatNothingTies) {
  const auto rig = test::simulate_rig(three_cameras(),
                                      {{0, 1}, {0, 1}, {0, 1}, {0, 1}, {0, 1}, {0, 1}, {2}, {2}, {2}, {2}, {2}, {2}},
                                      {.noise_px = 0.1}, 2);
  const RigCalibration found = calibrate(rig);
  EXPECT_EQ(found.outcome, Outcome::Untied);
  EXPECT_EQ(found.failed, std::vector<int>{2});
  EXPECT_EQ(explain(found, rig.cameras),
            "camera 'camera2' never sees the board at a moment at which the others do; show it the board together "
            "with one of them, and check that images of one moment bear the same number");
}

// The second camera's images are one late: at no moment do both show the board at one place.
TEST(ExplainRig, NamesACameraOfOtherMoments) {
  auto cameras = three_cameras();
  cameras.resize(2);
  auto rig = test::simulate_rig(cameras, std::vector<std::vector<int>>(10, {0, 1}), {.noise_px = 0.1}, 2);
  for (BoardView& view : rig.cameras[1].views) ++view.frame;
  const RigCalibration found = calibrate(rig);
  EXPECT_EQ(found.outcome, Outcome::Disagreeing);
  EXPECT_EQ(explain(found, rig.cameras),
            "camera 'camera0' and the others do not show the same board at the same moments; check that images of one "
            "moment bear the same number, and that no camera was moved on the rig in between");
}

// A quarter of the moments are wrong: they are dropped.
TEST(CalibrateRig, DropsMomentsThatDisagree) {
  auto cameras = three_cameras();
  cameras.resize(2);
  auto rig = test::simulate_rig(cameras, std::vector<std::vector<int>>(16, {0, 1}), {.noise_px = 0.1}, 1);
  for (int i = 0; i < 4; ++i) rig.cameras[1].views[static_cast<std::size_t>(i)].frame = (i + 1) % 4;
  const RigCalibration found = calibrate(rig);
  ASSERT_EQ(found.outcome, Outcome::Calibrated) << explain(found, rig.cameras);
  EXPECT_LT(difference(cameras[1].T_rig_camera, found.fit.bundle.cameras[1].T_rig_camera).norm(), 0.003);
  EXPECT_GE(found.pairs[0].corners, 12 * 54 - 3);
  EXPECT_LE(found.pairs[0].corners, 12 * 54);
}

TEST(ExplainRig, NamesTheCameraThatFailsAlone) {
  auto rig = chained_rig(0.1, 2);
  rig.cameras[1].views.resize(1);
  const RigCalibration found = calibrate(rig);
  EXPECT_EQ(found.outcome, Outcome::CameraFailed);
  EXPECT_EQ(found.failed, std::vector<int>{1});
  EXPECT_EQ(explain(found, rig.cameras),
            "camera 'camera1': the board is seen in 1 image, three are the least; take 10 to 20 with the board at "
            "different places and tilts");
}

TEST(ExplainRig, Stopped) {
  const auto rig = chained_rig(0.1, 2);
  std::stop_source stop;
  stop.request_stop();
  const auto found = calibrate_rig(test::simulated_board(), rig.cameras, {}, {}, stop.get_token());
  EXPECT_EQ(found.outcome, Outcome::Stopped);
  EXPECT_EQ(explain(found, rig.cameras), "stopped");
}

}  // namespace
}  // namespace alidade
