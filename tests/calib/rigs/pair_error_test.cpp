// SPDX-License-Identifier: Apache-2.0
#include "calib/rigs/pair_error.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

// Two pinholes of 500 px side by side, 0.1 m apart, at the truth of what they see.
struct Stereo {
  BundleFit fit;
  BundleFreedom freedom;
  BundleCovariance covariance;
};

Stereo make_stereo() {
  Stereo stereo;
  const Camera camera = start_camera(LensModel::Radial, 640, 480, 500);
  const Eigen::Isometry3d T_rig_camera(Eigen::Translation3d(0.1, 0, 0));
  stereo.fit.bundle.cameras = {{camera, Eigen::Isometry3d::Identity()}, {camera, T_rig_camera}};
  const auto rig = test::simulate_rig(stereo.fit.bundle.cameras, {{0, 1}, {0}, {1}, {0, 1}}, {}, 5);
  stereo.fit.bundle.T_rig_board = rig.T_rig_board;
  for (int c = 0; c < 2; ++c) {
    for (const BoardView& view : rig.cameras[static_cast<std::size_t>(c)].views) {
      stereo.fit.views.push_back({c, view.frame, view.corners, std::vector<double>(view.corners.size(), 1.0)});
    }
  }
  stereo.freedom.warp = false;
  stereo.covariance.shared_and_motion = Eigen::MatrixXd::Zero(12, 12);
  return stereo;
}

std::optional<PairError> error_of(const Stereo& stereo) {
  return pair_error(stereo.fit, stereo.freedom, stereo.covariance, 0, 1);
}

TEST(PairError, IsNoneOfExactViews) {
  const auto error = error_of(make_stereo());
  ASSERT_TRUE(error);
  EXPECT_EQ(error->first, 0);
  EXPECT_EQ(error->second, 1);
  EXPECT_EQ(error->corners, 2 * 54);
  EXPECT_LT(error->epipolar_rms_px, 1e-9);
  EXPECT_NEAR(error->baseline_m, 0.1, 1e-12);
}

// The epipolar lines of cameras side by side are rows: only what is lost in height counts.
TEST(PairError, IsTheDistanceFromTheEpipolarLine) {
  Stereo stereo = make_stereo();
  for (BundleView& view : stereo.fit.views) {
    for (BoardCorner& corner : view.corners) {
      if (view.camera == 1) corner.pixel += Eigen::Vector2d(5, 2);
    }
  }
  EXPECT_NEAR(error_of(stereo)->epipolar_rms_px, 2, 1e-9);
}

TEST(PairError, LeavesOutCornersWithoutWeight) {
  Stereo stereo = make_stereo();
  stereo.fit.views[0].corners[7].pixel.y() += 30;
  stereo.fit.views[0].weights[7] = 0;
  const auto error = error_of(stereo);
  EXPECT_EQ(error->corners, 2 * 54 - 1);
  EXPECT_LT(error->epipolar_rms_px, 1e-9);
}

// The second camera's place along its own x, the baseline's direction, is known to 3 mm, across it to 50 mm.
TEST(PairError, StatesTheBaselineAlongItself) {
  Stereo stereo = make_stereo();
  stereo.covariance.shared_and_motion.diagonal().head<3>() << 9e-6, 2.5e-3, 2.5e-3;
  EXPECT_NEAR(error_of(stereo)->baseline_sigma_m, 0.003, 1e-12);
  // Turned by 90 degrees about z, its y axis is what the baseline runs along.
  stereo.fit.bundle.cameras[1].T_rig_camera.rotate(Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ()));
  EXPECT_NEAR(error_of(stereo)->baseline_sigma_m, 0.05, 1e-12);
}

TEST(PairError, IsEmptyWithoutCommonCornersOrBaseline) {
  Stereo stereo = make_stereo();
  stereo.fit.bundle.cameras[1].T_rig_camera.setIdentity();
  EXPECT_FALSE(error_of(stereo));
  stereo = make_stereo();
  std::erase_if(stereo.fit.views, [](const BundleView& v) { return v.camera == 1 && v.frame != 2; });
  EXPECT_FALSE(error_of(stereo));
}

}  // namespace
}  // namespace alidade
