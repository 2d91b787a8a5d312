// SPDX-License-Identifier: Apache-2.0
#include "view/viewpoint.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace alidade {
namespace {

constexpr double kMargin = 1.07;    // of the distance that would just fit
constexpr double kLowShare = 0.03;  // of the map's points that may lie outside on each side
constexpr double kFarthest = 4.0;   // map points beyond this multiple of their median distance do not count at all

Eigen::Vector3d perpendicular(const Eigen::Vector3d& v) {
  return v.unitOrthogonal();
}

Eigen::Vector3d unit_or(const Eigen::Vector3d& v, const Eigen::Vector3d& otherwise) {
  return v.allFinite() && v.norm() > 1e-9 ? Eigen::Vector3d(v.normalized()) : otherwise;
}

// What the cameras take for up and where they look, perpendicular to each other.
struct SceneAxes {
  Eigen::Vector3d up, ahead;
};

SceneAxes axes_of(const Scene& scene) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero(), ahead = Eigen::Vector3d::Zero();
  for (const auto& camera : scene.cameras) {
    up -= camera.T_world_camera.linear().col(1);
    ahead += camera.T_world_camera.linear().col(2);
  }
  const double count = static_cast<double>(std::max<std::size_t>(1, scene.cameras.size()));
  if (!scene.up_world.isZero()) up = scene.up_world;
  if (up.norm() < 0.1 * count && scene.up_world.isZero()) up = -Eigen::Vector3d::UnitY();
  up.normalize();
  ahead -= up * up.dot(ahead);
  if (ahead.norm() < 0.1 * count) {  // cameras that look all round: take the first one's word
    ahead = scene.cameras.empty() ? Eigen::Vector3d::UnitZ()
                                  : Eigen::Vector3d(scene.cameras.front().T_world_camera.linear().col(2));
    ahead -= up * up.dot(ahead);
  }
  return {up, unit_or(ahead, perpendicular(up))};
}

// What must be in the picture.
std::vector<Eigen::Vector3d> firm_points(const Scene& scene) {
  std::vector<Eigen::Vector3d> points;
  const auto add = [&points](const Eigen::Vector3d& p) {
    if (p.allFinite()) points.push_back(p);
  };
  for (const auto& camera : scene.cameras) {
    std::ranges::for_each(pyramid_corners(camera, scene), add);
  }
  for (const auto& path : scene.paths) std::ranges::for_each(path.points_world, add);
  for (const auto& surface : scene.surfaces) std::ranges::for_each(surface.vertices_world, add);
  for (const auto& surface : scene.translucent) std::ranges::for_each(surface.vertices_world, add);
  return points;
}

Eigen::Vector3d mean(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

// The value below which `share` of the values lie; reorders them.
double percentile(std::vector<double>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The map's points without the far ones, seen from the middle of what is firm.
std::vector<Eigen::Vector3d> soft_points(const Scene& scene, const std::vector<Eigen::Vector3d>& firm) {
  std::vector<Eigen::Vector3d> points;
  for (const auto& point : scene.points) {
    if (point.p_world.allFinite()) points.push_back(point.p_world);
  }
  if (points.empty()) return points;
  Eigen::Vector3d middle;
  if (firm.empty()) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> values;
      for (const auto& p : points) values.push_back(p[axis]);
      middle[axis] = percentile(values, 0.5);
    }
  } else {
    middle = mean(firm);
  }
  std::vector<double> distances;
  for (const auto& p : points) distances.push_back((p - middle).norm());
  const double limit = kFarthest * percentile(distances, 0.5);
  std::erase_if(points, [&](const Eigen::Vector3d& p) { return (p - middle).norm() > limit; });
  return points;
}

struct Range {
  double low, high;
};

// Of what is firm all, of the rest the middle share, along one direction.
Range range_along(const std::vector<Eigen::Vector3d>& firm, const std::vector<Eigen::Vector3d>& soft,
                  const Eigen::Vector3d& direction) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const auto& p : firm) {
    range = {std::min(range.low, direction.dot(p)), std::max(range.high, direction.dot(p))};
  }
  if (soft.empty()) return range;
  std::vector<double> values;
  for (const auto& p : soft) values.push_back(direction.dot(p));
  range.low = std::min(range.low, percentile(values, kLowShare));
  range.high = std::max(range.high, percentile(values, 1.0 - kLowShare));
  return range;
}

}  // namespace

Viewpoint frame_scene(const Scene& scene, const ViewAngles& angles, double aspect) {
  const auto firm = firm_points(scene);
  const auto soft = soft_points(scene, firm);
  Viewpoint view;
  if (firm.empty() && soft.empty()) return view;
  const SceneAxes axes = axes_of(scene);
  const Eigen::Vector3d right = axes.ahead.cross(axes.up);
  const Eigen::Vector3d round = -axes.ahead * std::cos(angles.azimuth_rad) + right * std::sin(angles.azimuth_rad);
  const Eigen::Vector3d backward = round * std::cos(angles.elevation_rad) + axes.up * std::sin(angles.elevation_rad);
  view.up_world = axes.up;
  view.eye_world = backward;  // only to get the axes of the picture
  const Eigen::Matrix3d R_world_view = T_world_camera_of(view).linear();

  Eigen::Vector3d centre, half;
  for (int axis = 0; axis < 3; ++axis) {
    const Range range = range_along(firm, soft, R_world_view.col(axis));
    centre[axis] = 0.5 * (range.low + range.high);
    half[axis] = 0.5 * (range.high - range.low);
  }
  view.target_world = R_world_view * centre;
  const double slope_y = std::tan(0.5 * view.vertical_fov_rad), slope_x = slope_y * aspect;
  const auto distance_for = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d q = (R_world_view.transpose() * p - centre).cwiseMax(-half).cwiseMin(half);
    return std::max(std::abs(q.x()) / slope_x, std::abs(q.y()) / slope_y) - q.z();
  };
  double distance = 1e-3 * half.norm();
  for (const auto& p : firm) distance = std::max(distance, distance_for(p));
  for (const auto& p : soft) distance = std::max(distance, distance_for(p));
  if (!(distance > 0)) distance = 1.0;  // a single point
  view.eye_world = view.target_world + backward * distance * kMargin * angles.distance;
  return view;
}

Viewpoint turned(const Viewpoint& viewpoint, double angle_rad) {
  Viewpoint view = viewpoint;
  const Eigen::Vector3d up = unit_or(viewpoint.up_world, -Eigen::Vector3d::UnitY());
  view.eye_world = viewpoint.target_world +
                   Eigen::AngleAxisd(angle_rad, up) * Eigen::Vector3d(viewpoint.eye_world - viewpoint.target_world);
  return view;
}

Camera camera_of(const Viewpoint& viewpoint, cv::Size size) {
  Camera camera;
  camera.width = size.width;
  camera.height = size.height;
  camera.fx = camera.fy = 0.5 * size.height / std::tan(0.5 * viewpoint.vertical_fov_rad);
  camera.cx = 0.5 * (size.width - 1);
  camera.cy = 0.5 * (size.height - 1);
  return camera;
}

Eigen::Isometry3d T_world_camera_of(const Viewpoint& viewpoint) {
  const Eigen::Vector3d forward = unit_or(viewpoint.target_world - viewpoint.eye_world, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d right = unit_or(forward.cross(viewpoint.up_world), perpendicular(forward));
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear().col(0) = right;
  T_world_camera.linear().col(1) = forward.cross(right);
  T_world_camera.linear().col(2) = forward;
  T_world_camera.translation() = viewpoint.eye_world;
  return T_world_camera;
}

}  // namespace alidade
