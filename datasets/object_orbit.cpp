// SPDX-License-Identifier: Apache-2.0
#include "datasets/object_orbit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alidade {
namespace {

using std::numbers::pi;

constexpr double radians(double degrees) {
  return degrees * pi / 180.0;
}

double distance_m(OrbitPath path, double s) {
  if (path != OrbitPath::Turn) return 0.30 + 0.30 * (1.0 - std::sin(pi * s));
  const double u = 2.0 * s - 1.0;
  return 0.30 + 0.33 * (std::sqrt(u * u + 0.02) - std::sqrt(0.02));
}

// Three legs from rest to rest, each followed by a rest of three fifths of its time; the last one only ends.
double stop_and_go(double time) {
  constexpr double kLeg = 1.0 / (3.0 + 2.0 * 0.6), kPeriod = 1.6 * kLeg;
  const double leg = std::min(std::floor(time / kPeriod), 2.0);
  const double x = std::min((time - leg * kPeriod) / kLeg, 1.0);
  return (leg + x * x * (3.0 - 2.0 * x)) / 3.0;
}

Eigen::Isometry3d pose_at(OrbitPath path, double s) {
  const double wobble = path == OrbitPath::Turn ? 0.0 : 6.0 * std::sin(4.0 * pi * s);
  const double azimuth = radians(-50.0 + 100.0 * s + wobble), elevation = radians(12.0 + 14.0 * std::sin(2.0 * pi * s));
  const double roll = radians(18.0 * std::sin(2.0 * pi * s + 0.4));
  const Eigen::Vector3d outward(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                std::cos(elevation) * std::cos(azimuth));
  const Eigen::Vector3d centre = distance_m(path, s) * outward;
  const Eigen::Vector3d target =
      0.012 * Eigen::Vector3d(std::sin(3.0 * pi * s), std::cos(2.0 * pi * s), std::sin(2.0 * pi * s));
  // x right, y down, z forward, with the world's y up.
  Eigen::Matrix3d R;
  R.col(2) = (target - centre).normalized();
  R.col(0) = (-Eigen::Vector3d::UnitY()).cross(R.col(2)).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = R * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = centre;
  return T;
}

}  // namespace

std::vector<Eigen::Isometry3d> orbit_poses(OrbitPath path, int frames) {
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < frames; ++k) {
    const double s = static_cast<double>(k) / (frames - 1);
    poses.push_back(pose_at(path, path == OrbitPath::StopAndGo ? stop_and_go(s) : s));
  }
  return poses;
}

Camera orbit_camera() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 426.7;
  camera.cx = 320;
  camera.cy = 240;
  return camera;
}

std::vector<Eigen::Vector3d> orbit_object() {
  constexpr int kPoints = 453;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < kPoints; ++i) {  // a spiral of equal areas from pole to pole
    const double z = 1.0 - (2.0 * i + 1.0) / kPoints, turn = i * pi * (3.0 - std::sqrt(5.0));
    const double ring = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d direction(ring * std::cos(turn), ring * std::sin(turn), z);
    const double relief = 1.0 + 0.12 * std::sin(5.0 * direction.x() + 1.0) * std::sin(4.0 * direction.y()) +
                          0.08 * std::cos(7.0 * direction.z() + 2.0 * direction.x());
    points.emplace_back(relief * direction.cwiseProduct(Eigen::Vector3d(0.9, 1.0, 0.75)));
  }
  return fitted_to(0.15, std::move(points));
}

std::vector<Eigen::Vector3d> fitted_to(double size_m, std::vector<Eigen::Vector3d> points) {
  if (points.empty()) return points;
  Eigen::Vector3d low = points.front(), high = points.front();
  for (const Eigen::Vector3d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double longest = (high - low).maxCoeff();
  if (!(longest > 0)) return points;
  for (Eigen::Vector3d& p : points) p = (p - 0.5 * (low + high)) * (size_m / longest);
  return points;
}

std::vector<PointObservation> sighted(const Camera& camera, const Eigen::Isometry3d& T_world_camera,
                                      std::span<const Eigen::Vector3d> points, double sigma_px,
                                      std::mt19937_64& random) {
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  std::normal_distribution<double> normal;
  std::vector<PointObservation> observations;
  for (const Eigen::Vector3d& p : points) {
    const auto projection = project(camera, T_camera_world * p);
    if (!projection) continue;
    PointObservation o;
    o.pixel = projection->pixel + sigma_px * Eigen::Vector2d(normal(random), normal(random));
    o.p_world = p;
    observations.push_back(o);
  }
  return observations;
}

std::vector<PointObservation> with_outliers(const Camera& camera, std::vector<PointObservation> observations,
                                            double share, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform;
  for (PointObservation& o : observations) {
    if (uniform(random) >= share) continue;
    o.pixel = {uniform(random) * camera.width - 0.5, uniform(random) * camera.height - 0.5};
  }
  return observations;
}

}  // namespace alidade
