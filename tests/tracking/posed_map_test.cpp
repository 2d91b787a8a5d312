// SPDX-License-Identifier: Apache-2.0
#include "tracking/posed_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

constexpr unsigned kSeed = 73;
constexpr double kDepth = 2.0;  // m

// A wall of dark blobs at z = 2 m, seen by a camera that looks straight at it.
class PosedMap : public testing::Test {
 protected:
  PosedMap() {
    camera_.width = 320;
    camera_.height = 240;
    camera_.fx = camera_.fy = 260;
    camera_.cx = 160;
    camera_.cy = 120;
    test::RandomGeometry random(kSeed);
    for (int i = 0; i < 260; ++i) {
      blobs_.push_back({{random.uniform(-1.6, 2.0), random.uniform(-1.1, 1.1)},
                        random.uniform(0.015, 0.05),
                        random.uniform(40, 120)});
    }
  }

  PosedImage see(const Eigen::Vector3d& centre) const {
    PosedImage image;
    image.T_world_camera.translation() = centre;
    const double scale = camera_.fx / (kDepth - centre.z());
    cv::Mat grey(camera_.height, camera_.width, CV_32F, cv::Scalar(220));
    for (const Blob& b : blobs_) {
      const Eigen::Vector2d place = scale * (b.centre - centre.head<2>()) + Eigen::Vector2d(camera_.cx, camera_.cy);
      const double sigma = scale * b.sigma_m;
      for (int y = std::max(0, static_cast<int>(place.y() - 5 * sigma)); y < std::min(240.0, place.y() + 5 * sigma);
           ++y) {
        for (int x = std::max(0, static_cast<int>(place.x() - 5 * sigma)); x < std::min(320.0, place.x() + 5 * sigma);
             ++x) {
          const double r2 = (Eigen::Vector2d(x, y) - place).squaredNorm() / (sigma * sigma);
          grey.at<float>(y, x) -= static_cast<float>(b.depth * std::exp(-0.5 * r2));
        }
      }
    }
    grey.convertTo(image.frame.grey, CV_8U);
    return image;
  }

  PosedImage see_with_depth(const Eigen::Vector3d& centre) const {
    PosedImage image = see(centre);
    image.depth = cv::Mat(camera_.height, camera_.width, CV_16U, cv::Scalar(1000 * (kDepth - centre.z())));
    image.depth_unit_m = 1e-3;
    return image;
  }

  struct Blob {
    Eigen::Vector2d centre;  // m
    double sigma_m;
    double depth;  // grey levels
  };
  Camera camera_;
  std::vector<Blob> blobs_;
};

TEST_F(PosedMap, LiftsFeaturesByTheirDepth) {
  PosedImage image = see_with_depth({0, 0, 0});
  image.frame.index = 12;
  image.frame.name = "wall.png";
  image.frame.colour = cv::Mat(camera_.height, camera_.width, CV_8UC3, cv::Scalar(10, 20, 200));
  const LiveMap live = with_posed_image(camera_, {}, image, {});
  ASSERT_EQ(live.map.keyframes.size(), 1u);
  const Keyframe& keyframe = live.map.keyframes[0];
  EXPECT_EQ(keyframe.frame, 12);
  EXPECT_EQ(keyframe.image, "wall.png");
  ASSERT_GT(live.map.points.size(), 60u);
  ASSERT_EQ(keyframe.sightings.size(), live.map.points.size());
  for (const Sighting& s : keyframe.sightings) {
    const MapPoint& point = live.map.points[static_cast<std::size_t>(s.point)];
    EXPECT_NEAR(point.p_world.z(), kDepth, 1e-9);
    EXPECT_LT((project(camera_, point.p_world)->pixel - s.pixel).norm(), 1e-9);
    EXPECT_EQ(point.rgb, (std::array<std::uint8_t, 3>{200, 20, 10}));
  }
}

// On the axis: depth noise 0.0028 m × 2² along it, pixel and turn of the pose across it, and the pose's place.
TEST_F(PosedMap, KnowsTheNoiseOfALiftedPoint) {
  const PosedMapOptions options;
  const LiveMap live = with_posed_image(camera_, {}, see_with_depth({0, 0, 0}), options);
  const MapPoint* central = nullptr;
  for (const MapPoint& point : live.map.points) {
    if (!central || point.p_world.head<2>().norm() < central->p_world.head<2>().norm()) central = &point;
  }
  ASSERT_LT(central->p_world.head<2>().norm(), 0.2);
  EXPECT_NEAR(std::sqrt(central->covariance_world(2, 2)), std::hypot(0.0112, options.pose_sigma_m), 3e-4);
  const double across = std::hypot(kDepth / 260, kDepth * options.pose_sigma_rad);
  EXPECT_NEAR(std::sqrt(central->covariance_world(0, 0)), std::hypot(across, options.pose_sigma_m), 3e-4);
}

TEST_F(PosedMap, FindsKnownPointsAgainAndKnowsThemBetter) {
  const LiveMap one = with_posed_image(camera_, {}, see_with_depth({0, 0, 0}), {});
  const LiveMap two = with_posed_image(camera_, one, see_with_depth({0.2, 0, 0.1}), {});
  ASSERT_EQ(two.map.keyframes.size(), 2u);
  const std::vector<int> again = living_points(two.map);
  EXPECT_GT(again.size(), one.map.points.size() / 2);
  for (int i : again) {
    const auto index = static_cast<std::size_t>(i);
    EXPECT_NEAR(two.map.points[index].p_world.z(), kDepth, 0.01);
    ASSERT_LT(index, one.map.points.size());
    EXPECT_LT(two.map.points[index].covariance_world.trace(), 0.9 * one.map.points[index].covariance_world.trace());
  }
  EXPECT_GT(two.map.points.size(), one.map.points.size());  // what came into view
  for (const MapPoint& point : two.map.points) EXPECT_NEAR(point.p_world.z(), kDepth, 0.01);
}

TEST_F(PosedMap, TriangulatesWithoutDepth) {
  LiveMap live;
  for (double x : {0.0, 0.15, 0.3}) live = with_posed_image(camera_, std::move(live), see({x, 0, 0}), {});
  ASSERT_GT(live.map.points.size(), 40u);
  int far = 0;
  for (int i : living_points(live.map)) {
    far += std::abs(live.map.points[static_cast<std::size_t>(i)].p_world.z() - kDepth) > 0.05;
  }
  EXPECT_LE(far, 2);
}

// The right half of the wall is said to be a metre farther: within two pixels of the step nothing is believed.
TEST_F(PosedMap, LeavesOutFeaturesOnDepthEdges) {
  PosedImage image = see_with_depth({0, 0, 0});
  image.depth.colRange(160, 320).setTo(cv::Scalar(3000));
  const LiveMap live = with_posed_image(camera_, {}, image, {});
  int near = 0, far = 0;
  for (const Sighting& s : live.map.keyframes[0].sightings) {
    EXPECT_GT(std::abs(s.pixel.x() - 159.5), 1.9);
    const double z = live.map.points[static_cast<std::size_t>(s.point)].p_world.z();
    EXPECT_NEAR(z, s.pixel.x() < 160 ? 2.0 : 3.0, 1e-9);
    (z < 2.5 ? near : far) += 1;
  }
  EXPECT_GT(near, 20);
  EXPECT_GT(far, 20);
}

TEST_F(PosedMap, LiftsNothingByUnknownOrTooGreatDepth) {
  PosedImage image = see_with_depth({0, 0, 0});
  image.depth.setTo(cv::Scalar(0));
  EXPECT_TRUE(with_posed_image(camera_, {}, image, {}).map.points.empty());
  image.depth.setTo(cv::Scalar(6100));
  EXPECT_TRUE(with_posed_image(camera_, {}, image, {}).map.points.empty());
  image.depth.setTo(cv::Scalar(5900));
  EXPECT_FALSE(with_posed_image(camera_, {}, image, {}).map.points.empty());
}

}  // namespace
}  // namespace alidade
