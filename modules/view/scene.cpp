// SPDX-License-Identifier: Apache-2.0
#include "view/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Eigenvalues>

namespace alidade {
namespace {

// Indices 0..count-1, evenly thinned to at most `most`, the first and last among them.
std::vector<std::size_t> evenly(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen;
  if (count <= most) {
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(i);
  } else if (most == 1) {
    chosen.push_back(0);
  } else {
    for (std::size_t k = 0; k < most; ++k) chosen.push_back(k * (count - 1) / (most - 1));
  }
  return chosen;
}

Eigen::Vector2d half_extent(const Camera& camera) {
  return {0.5 * camera.width / camera.fx, 0.5 * camera.height / camera.fy};
}

double extent_of_centres(const Trajectory& trajectory) {
  Eigen::AlignedBox3d box;
  for (const auto& pose : trajectory) box.extend(pose.T_world_camera.translation());
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

double median_distance(const PointMap& map, const Eigen::Vector3d& from) {
  if (map.points.empty()) return 0.0;
  std::vector<double> distances;
  for (const auto& point : map.points) distances.push_back((point.p_world - from).norm());
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

// A pyramid that can be seen beside its path and does not hide it: a share of the path, or of the distance to the map
// where the camera hardly moved.
double pyramid_depth(const Trajectory& trajectory, const PointMap& points) {
  if (trajectory.empty()) return Scene{}.pyramid_depth_m;
  const double path = extent_of_centres(trajectory);
  const double map = median_distance(points, trajectory.front().T_world_camera.translation());
  const double depth = std::max(0.07 * path, 0.025 * map);
  return depth > 0 ? depth : Scene{}.pyramid_depth_m;
}

// So many that they stand apart; few cameras are all shown.
std::size_t pyramids_that_fit(const Trajectory& trajectory, double depth_m) {
  constexpr double kSpacing = 1.3;  // in depths of a pyramid
  const double fitting = path_length(trajectory) / (kSpacing * depth_m);
  return static_cast<std::size_t>(std::clamp(fitting, 12.0, 40.0));
}

// Few points are drawn larger, so that the map can be seen.
double point_size_px(std::size_t count) {
  return std::clamp(7.5 - 1.1 * std::log10(static_cast<double>(count) + 1.0), 2.0, 5.0);
}

// A solid pyramid stands inside the hollow one of the same pose.
void shrink(std::vector<CameraPyramid>& pyramids, double depth_m) {
  for (auto& pyramid : pyramids) pyramid.depth_m = 0.8 * depth_m;
}

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

std::vector<Eigen::Vector3d> pyramid_corners(const CameraPyramid& pyramid, const Scene& scene) {
  const double depth_m = pyramid.depth_m > 0 ? pyramid.depth_m : scene.pyramid_depth_m;
  const double x = pyramid.half_extent.x(), y = pyramid.half_extent.y();
  std::vector<Eigen::Vector3d> corners{pyramid.T_world_camera.translation()};
  for (const Eigen::Vector3d& d :
       {Eigen::Vector3d(-x, -y, 1), Eigen::Vector3d(x, -y, 1), Eigen::Vector3d(x, y, 1), Eigen::Vector3d(-x, y, 1)}) {
    corners.push_back(pyramid.T_world_camera * Eigen::Vector3d(d * depth_m));
  }
  return corners;
}

std::vector<ScenePoint> scene_points(const PointMap& map, std::size_t most) {
  std::vector<ScenePoint> points;
  for (const std::size_t i : evenly(map.points.size(), most)) {
    points.push_back({map.points[i].p_world, map.points[i].rgb});
  }
  return points;
}

ScenePath scene_path(const Trajectory& trajectory, const Rgb& colour, RecordingClock::duration longest_gap) {
  ScenePath path;
  path.colour = colour;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (i > 0 && trajectory[i].time - trajectory[i - 1].time > longest_gap) {
      path.points_world.emplace_back(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
    }
    path.points_world.push_back(trajectory[i].T_world_camera.translation());
  }
  return path;
}

std::vector<CameraPyramid> scene_pyramids(const Trajectory& trajectory, PyramidStyle style, const Rgb& colour,
                                          const std::optional<Camera>& camera, std::size_t most) {
  std::vector<CameraPyramid> pyramids;
  for (const std::size_t i : evenly(trajectory.size(), most)) {
    CameraPyramid pyramid;
    pyramid.T_world_camera = trajectory[i].T_world_camera;
    pyramid.colour = colour;
    pyramid.style = style;
    if (camera) pyramid.half_extent = half_extent(*camera);
    pyramids.push_back(pyramid);
  }
  return pyramids;
}

TranslucentSurface covariance_ellipsoid(const Eigen::Vector3d& mean_world, const Eigen::Matrix3d& covariance_world,
                                        double sigmas, const Rgb& colour) {
  constexpr int kRound = 16, kUp = 8;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance_world);
  const Eigen::Matrix3d axes =
      eigen.eigenvectors() * (sigmas * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt()).asDiagonal();
  TranslucentSurface surface;
  surface.colour = colour;
  surface.opacity = 0.3;
  for (int up = 0; up <= kUp; ++up) {
    const double elevation = std::numbers::pi * (static_cast<double>(up) / kUp - 0.5);
    for (int round = 0; round < kRound; ++round) {
      const double azimuth = 2.0 * std::numbers::pi * round / kRound;
      const Eigen::Vector3d d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                              std::sin(elevation));
      surface.vertices_world.emplace_back(mean_world + axes * d);
      if (up == 0) continue;
      const int here = up * kRound + round, next = up * kRound + (round + 1) % kRound;
      surface.triangles.emplace_back(here - kRound, next - kRound, next);
      surface.triangles.emplace_back(here - kRound, next, here);
    }
  }
  return surface;
}

Scene track_scene(const TrackPicture& picture) {
  Scene scene;
  scene.title = picture.title;
  scene.points = scene_points(picture.map);
  scene.point_size_px = point_size_px(scene.points.size());
  const bool estimated = !picture.estimate.empty();
  const Trajectory& leading = estimated || !picture.truth ? picture.estimate : *picture.truth;
  scene.pyramid_depth_m = pyramid_depth(leading, picture.map);
  const std::size_t most = pyramids_that_fit(leading, scene.pyramid_depth_m);
  if (picture.truth) {
    scene.paths.push_back(scene_path(*picture.truth, palette::kTruth));
    auto solid = scene_pyramids(*picture.truth, PyramidStyle::Solid, palette::kTruth, picture.camera, most);
    shrink(solid, scene.pyramid_depth_m);
    append(scene.cameras, solid);
    scene.legend.push_back({"true cameras", palette::kTruth, PyramidStyle::Solid});
  }
  if (estimated) {
    scene.paths.push_back(scene_path(picture.estimate, palette::kEstimate));
    append(scene.cameras,
           scene_pyramids(picture.estimate, PyramidStyle::Hollow, palette::kEstimate, picture.camera, most));
    scene.legend.push_back({"estimated cameras", palette::kEstimate, PyramidStyle::Hollow});
  }
  return scene;
}

}  // namespace alidade
