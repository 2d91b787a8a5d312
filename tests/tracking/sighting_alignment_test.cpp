// SPDX-License-Identifier: Apache-2.0
#include "tracking/sighting_alignment.h"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/rotation.h"
#include "tests/geometry/random_geometry.h"

namespace alidade {
namespace {

const Camera kCamera{320, 240, 300, 300, 160, 120, {}};

// A textured wall z = 0.3 x + 2, in m.
double texture(double x, double y) {
  return 128 + 35 * std::sin(80 * x + 36 * y) + 30 * std::sin(26 * x - 73 * y + 1) + 20 * std::cos(56 * x + 99 * y);
}

std::optional<Eigen::Vector3d> wall_at(const Eigen::Isometry3d& T_world_camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d d = T_world_camera.linear() * *unproject(kCamera, pixel);
  const Eigen::Vector3d& c = T_world_camera.translation();
  const double range = (2 + 0.3 * c.x() - c.z()) / (d.z() - 0.3 * d.x());
  if (!(range > 0)) return std::nullopt;
  return c + range * d;
}

cv::Mat see(const Eigen::Isometry3d& T_world_camera) {
  cv::Mat grey(kCamera.height, kCamera.width, CV_8U, cv::Scalar(0));
  for (int y = 0; y < grey.rows; ++y) {
    for (int x = 0; x < grey.cols; ++x) {
      const auto p = wall_at(T_world_camera, {x, y});
      if (p) grey.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(texture(p->x(), p->y()));
    }
  }
  return grey;
}

// Three views of the wall; every sighting is off by up to `noise_px` in either coordinate.
LiveMap three_views(double noise_px) {
  test::RandomGeometry random(31);
  LiveMap live;
  for (int k = 0; k < 3; ++k) {
    Keyframe keyframe;
    keyframe.frame = k;
    keyframe.T_world_camera.translation() = Eigen::Vector3d(0.25 * (k - 1), 0.02 * k, 0.05 * k);
    keyframe.T_world_camera.linear() = exp_so3(Eigen::Vector3d(0.02, -0.12 * (k - 1), 0.1 * (k - 1)));
    live.map.keyframes.push_back(keyframe);
    live.features.push_back({{}, {}, see(keyframe.T_world_camera)});
  }
  for (double x = 80; x < 240; x += 20) {
    for (double y = 60; y < 180; y += 20) {
      MapPoint point;
      point.p_world = *wall_at(live.map.keyframes[1].T_world_camera, {x, y});
      const int index = static_cast<int>(live.map.points.size());
      live.map.points.push_back(point);
      for (Keyframe& keyframe : live.map.keyframes) {
        const Eigen::Vector2d noise(random.uniform(-noise_px, noise_px), random.uniform(-noise_px, noise_px));
        const auto projection = project(kCamera, keyframe.T_world_camera.inverse() * point.p_world);
        keyframe.sightings.push_back({index, projection->pixel + noise, 1.0});
      }
    }
  }
  return live;
}

TEST(AlignSightings, LetsAllViewsOfAPointShowTheSameSpot) {
  const LiveMap before = three_views(0.7);
  const SightingAlignment alignment = align_sightings(kCamera, before);
  const auto& views = alignment.live.map.keyframes;
  const std::size_t count = before.map.points.size();
  EXPECT_GT(alignment.aligned, static_cast<int>(2.7 * static_cast<double>(count)));
  double worst = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (views[0].sightings[i].sigma_px == 1.0 || views[2].sightings[i].sigma_px == 1.0) continue;
    const Sighting& middle = views[1].sightings[i];
    EXPECT_EQ(middle.pixel, before.map.keyframes[1].sightings[i].pixel);  // the reference stays
    const auto spot = wall_at(views[1].T_world_camera, middle.pixel);
    for (std::size_t k : {0, 2}) {
      const auto there = project(kCamera, views[k].T_world_camera.inverse() * *spot);
      worst = std::max(worst, (there->pixel - views[k].sightings[i].pixel).norm());
    }
  }
  EXPECT_LT(worst, 0.15);
}

TEST(AlignSightings, LeavesAloneWhatDoesNotAgree) {
  LiveMap live = three_views(0);
  live.features[0].grey = cv::Mat(kCamera.height, kCamera.width, CV_8U, cv::Scalar(50));
  const LiveMap before = live;
  const SightingAlignment alignment = align_sightings(kCamera, std::move(live));
  for (std::size_t i = 0; i < before.map.points.size(); ++i) {
    EXPECT_EQ(alignment.live.map.keyframes[0].sightings[i].pixel, before.map.keyframes[0].sightings[i].pixel);
    EXPECT_EQ(alignment.live.map.keyframes[0].sightings[i].sigma_px, 1.0);
  }
}

}  // namespace
}  // namespace alidade
