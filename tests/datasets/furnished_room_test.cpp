// SPDX-License-Identifier: Apache-2.0
#include "datasets/furnished_room.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

TEST(FurnishedRoom, StandsOnItsFloorAndIsNotFlat) {
  const Scene room = make_furnished_room({0.01, 3});
  EXPECT_GT(room.surfaces.size(), 15u);
  Eigen::AlignedBox3d box;
  for (const auto& s : room.surfaces) {
    for (const auto& v : s.vertices_world) box.extend(v);
  }
  EXPECT_TRUE(box.min().isApprox(Eigen::Vector3d(-3, -2.5, 0), 1e-9));
  EXPECT_TRUE(box.max().isApprox(Eigen::Vector3d(3, 2.5, 2.8), 1e-9));
  // The wall behind the table comes forward by more than 10 cm somewhere.
  double relief = 0;
  for (const auto& v : room.surfaces.front().vertices_world) relief = std::max(relief, 2.5 - v.y());
  EXPECT_GT(relief, 0.1);
}

TEST(FurnishedRoom, EverySurfaceHasItsOwnTexture) {
  const Scene room = make_furnished_room({0.02, 3});
  for (std::size_t a = 0; a < room.surfaces.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const auto &x = room.surfaces[a].texture, &y = room.surfaces[b].texture;
      if (x.size() != y.size()) continue;
      EXPECT_GT(cv::norm(x, y, cv::NORM_L1), static_cast<double>(x.total())) << a << " " << b;
    }
  }
}

TEST(MakeMarker, PictureIsReadableAndItsBlackSquareHasTheSideAskedFor) {
  const TexturedSurface marker = make_marker(Eigen::Isometry3d::Identity(), 0.16);
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;
  cv::Mat smaller, padded;  // the detector's windows are made for markers of some tens of pixels
  cv::resize(marker.texture, smaller, {}, 0.25, 0.25, cv::INTER_AREA);
  cv::copyMakeBorder(smaller, padded, 20, 20, 20, 20, cv::BORDER_CONSTANT, cv::Scalar::all(200));
  cv::aruco::detectMarkers(padded, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11), corners, ids);
  ASSERT_EQ(ids, std::vector<int>{0});
  const double side_m = (marker.vertices_world[1] - marker.vertices_world[0]).norm();
  EXPECT_NEAR(side_m * (corners[0][1].x - corners[0][0].x + 1) / smaller.cols, 0.16, 3e-3);
  EXPECT_LT(marker.vertices_world[0].x(), 0);  // the picture's top left is at the marker's left and up
  EXPECT_GT(marker.vertices_world[0].y(), 0);
}

}  // namespace
}  // namespace alidade
