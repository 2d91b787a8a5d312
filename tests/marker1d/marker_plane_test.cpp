// SPDX-License-Identifier: Apache-2.0
#include "marker1d/marker_plane.h"

#include <gtest/gtest.h>

#include "datasets/body_scene.h"

namespace alidade {
namespace {

class MarkerPlanes : public testing::Test {
 protected:
  MarkerPlanes() : scene_(options()), frame_(*scene_.next()), T_(pose_in_scene(0, frame_.time)) {}

  static BodySceneOptions options() {
    BodySceneOptions options;
    options.bodies = 2;
    options.sigma_rad = 0.0;
    return options;
  }

  BodyScene scene_;
  BodySceneFrame frame_;
  Eigen::Isometry3d T_;
};

TEST_F(MarkerPlanes, GoThroughTheMarkersOfTheBodyAlone) {
  for (LineReading& r : frame_.readings) r.sigma = 1e-4;
  const RigidBody& body = scene_.bodies()[0];
  const auto planes = marker_planes(scene_.detectors(), body, frame_.readings, T_);
  ASSERT_EQ(planes.size(), 48u);
  for (const MarkerPlane& plane : planes) {
    const Eigen::Vector3d p_world = T_ * body.markers[static_cast<std::size_t>(plane.marker)].p_body;
    EXPECT_NEAR(distance(plane.plane_world, p_world), 0.0, 1e-14);
    EXPECT_NEAR(plane.plane_world.normal.norm(), 1.0, 1e-14);
  }
  // Of the second body the markers' places in the body, not their ids.
  const auto others = marker_planes(scene_.detectors(), scene_.bodies()[1], frame_.readings, std::nullopt);
  ASSERT_EQ(others.size(), 48u);
  EXPECT_EQ(others[0].marker, 0);
}

TEST_F(MarkerPlanes, WeighByAngleTimesRange) {
  for (LineReading& r : frame_.readings) r.sigma = 2e-4;
  const RigidBody& body = scene_.bodies()[0];
  const auto planes = marker_planes(scene_.detectors(), body, frame_.readings, T_);
  const LineDetector& first = scene_.detectors()[0];
  const Eigen::Vector3d p_detector = (first.T_world_station * first.T_station_detector).inverse() * T_ *
                                     body.markers[static_cast<std::size_t>(planes[0].marker)].p_body;
  const double range_m = std::hypot(p_detector.x(), p_detector.z());  // from the focal line
  EXPECT_NEAR(planes[0].weight * std::pow(2e-4 * range_m, 2), 1.0, 1e-12);
  const auto anywhere = marker_planes(scene_.detectors(), body, frame_.readings, std::nullopt);
  EXPECT_NEAR(anywhere[0].weight * 4e-8, 1.0, 1e-12);
  EXPECT_LT((anywhere[0].plane_world.normal - planes[0].plane_world.normal).norm(), 1e-14);
}

TEST_F(MarkerPlanes, LeaveOutMarkersBehindTheDetectorAndRefuseUnknownOnes) {
  for (LineReading& r : frame_.readings) r.sigma = 1e-4;
  const RigidBody& body = scene_.bodies()[0];
  const Eigen::Isometry3d behind = Eigen::Translation3d(50, 15, 0) * T_;
  EXPECT_LT(marker_planes(scene_.detectors(), body, frame_.readings, behind).size(), 48u);
  EXPECT_TRUE(marker_planes(scene_.detectors(), body, {}, T_).empty());
  frame_.readings[0].detector = 99;
  EXPECT_THROW(marker_planes(scene_.detectors(), body, frame_.readings, T_), std::invalid_argument);
  std::vector<LineDetector> noiseless = scene_.detectors();
  noiseless[0].sigma = 0.0;
  const std::vector<LineReading> reading{{{}, 0, 0, 0.0, 0.0}};
  EXPECT_THROW(marker_planes(noiseless, body, reading, T_), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
