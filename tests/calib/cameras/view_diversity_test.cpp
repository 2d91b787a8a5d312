// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/view_diversity.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/calib/simulated_views.h"

namespace alidade {
namespace {

// Corners `first` .. `last` of a row 10 px apart, shifted to the right.
BundleView row_of(int first, int last, double shift_px, int camera = 0) {
  BundleView view;
  view.camera = camera;
  for (int id = first; id <= last; ++id) view.corners.push_back({id, {10.0 * id + shift_px, 5.0}, 0.1});
  view.weights.assign(view.corners.size(), 1.0);
  return view;
}

TEST(RepeatedViews, NameTheFirstThatShowsTheSame) {
  const std::vector<BundleView> views{row_of(0, 9, 0), row_of(0, 9, 5), row_of(0, 9, 0.4), row_of(0, 9, 5.3),
                                      row_of(0, 9, 0.8)};
  EXPECT_EQ(find_repeated_views(views, 1.0), (std::vector<int>{-1, -1, 0, 1, 0}));
  EXPECT_EQ(find_repeated_views(views, 0.5), (std::vector<int>{-1, -1, 0, 1, -1}));
}

// A view that drifts by 0.6 px at a time repeats the first of a run, never the one before.
TEST(RepeatedViews, AreComparedWithThoseThatStay) {
  const std::vector<BundleView> views{row_of(0, 9, 0), row_of(0, 9, 0.6), row_of(0, 9, 1.2), row_of(0, 9, 1.8)};
  EXPECT_EQ(find_repeated_views(views, 1.0), (std::vector<int>{-1, 0, -1, 2}));
}

TEST(RepeatedViews, NeedMostCornersInCommon) {
  EXPECT_EQ(find_repeated_views(std::vector{row_of(0, 9, 0), row_of(2, 11, 0)}, 1.0), (std::vector<int>{-1, 0}));
  EXPECT_EQ(find_repeated_views(std::vector{row_of(0, 9, 0), row_of(3, 12, 0)}, 1.0), (std::vector<int>{-1, -1}));
  EXPECT_EQ(find_repeated_views(std::vector{row_of(0, 9, 0), row_of(20, 29, 0)}, 1.0), (std::vector<int>{-1, -1}));
  EXPECT_EQ(find_repeated_views(std::vector{BundleView{}, BundleView{}}, 1.0), (std::vector<int>{-1, -1}));
}

TEST(RepeatedViews, AreOfOneCamera) {
  EXPECT_EQ(find_repeated_views(std::vector{row_of(0, 9, 0, 0), row_of(0, 9, 0, 1)}, 1.0), (std::vector<int>{-1, -1}));
}

BundleView seen_by(int camera, int frame) {
  BundleView view{camera, frame, {{0, {1, 1}, 0.1}}, {1.0}};
  return view;
}

TEST(TiltSpread, IsTheLargestAngleBetweenNormals) {
  BoardBundle bundle;
  bundle.cameras.resize(2);
  for (const double tilt : {0.1, -0.3, 0.4}) {
    bundle.T_rig_board.emplace_back(Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()));
  }
  bundle.T_rig_board.emplace_back(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()));  // no tilt
  const std::vector<BundleView> views{seen_by(0, 0), seen_by(0, 1), seen_by(1, 2), seen_by(0, 3)};
  EXPECT_NEAR(tilt_spread_rad(bundle, views, 0), 0.4, 1e-9);
  EXPECT_EQ(tilt_spread_rad(bundle, views, 1), 0);
}

TEST(TiltSpread, LeavesOutViewsWithoutWeight) {
  BoardBundle bundle;
  bundle.cameras.resize(1);
  for (const double tilt : {0.1, -0.3, 0.8}) {
    bundle.T_rig_board.emplace_back(Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()));
  }
  std::vector<BundleView> views{seen_by(0, 0), seen_by(0, 1), seen_by(0, 2)};
  views[2].weights = {0.0};
  EXPECT_NEAR(tilt_spread_rad(bundle, views, 0), 0.4, 1e-9);
}

}  // namespace
}  // namespace alidade
