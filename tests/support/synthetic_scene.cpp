// SPDX-License-Identifier: Apache-2.0
#include "tests/support/synthetic_scene.h"

#include <cmath>

namespace alidade::test {

Camera vga_camera() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = 520;
  camera.fy = 515;
  camera.cx = 322;
  camera.cy = 238;
  camera.distortion = BrownConrady{-0.12, 0.03, 0.001, -0.0005, 0};
  return camera;
}

Eigen::Isometry3d looking_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  const Eigen::Vector3d z = (target - eye).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << x, z.cross(x), z;
  T.translation() = eye;
  return T;
}

std::vector<Sighting> sightings_from(const Camera& camera, const std::vector<MapPoint>& points,
                                     const Eigen::Isometry3d& T_world_camera, double noise_px, RandomGeometry& random) {
  std::vector<Sighting> sightings;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto projection = project(camera, T_world_camera.inverse() * points[i].p_world);
    if (!projection || !is_inside(camera, projection->pixel)) continue;
    const Eigen::Vector2d noise(random.normal(noise_px), random.normal(noise_px));
    sightings.push_back({static_cast<int>(i), projection->pixel + noise, noise_px > 0 ? noise_px : 1.0});
  }
  return sightings;
}

PointMap make_map(const Camera& camera, int count, int keyframes, double noise_px, RandomGeometry& random) {
  PointMap map;
  map.points.resize(static_cast<std::size_t>(count));
  for (MapPoint& point : map.points) {
    point.p_world = {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-1.5, 1.5)};
  }
  for (int k = 0; k < keyframes; ++k) {
    const double angle = 0.15 * k;
    Keyframe keyframe;
    keyframe.frame = k;
    keyframe.time = Timestamp(std::chrono::milliseconds(100 * k));
    keyframe.T_world_camera = looking_at({6 * std::cos(angle), 6 * std::sin(angle), 0.5 + 0.1 * k}, {0, 0, 0});
    keyframe.sightings = sightings_from(camera, map.points, keyframe.T_world_camera, noise_px, random);
    map.keyframes.push_back(keyframe);
  }
  return map;
}

std::vector<PointObservation> observations_of(const PointMap& map, std::size_t keyframe) {
  std::vector<PointObservation> observations;
  for (const Sighting& s : map.keyframes[keyframe].sightings) {
    const MapPoint& point = map.points[static_cast<std::size_t>(s.point)];
    observations.push_back({s.pixel, s.sigma_px, point.p_world, point.covariance_world, {}});
  }
  return observations;
}

}  // namespace alidade::test
