// SPDX-License-Identifier: Apache-2.0
#include "app/body_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

namespace alidade {
namespace {

constexpr Rgb kSight{176, 180, 190};

// How the view of a camera (x right, y down, z forward) lies in the frame of a model.
Eigen::Matrix3d R_model_view(const LineModel& model) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  if (std::holds_alternative<Lighthouse1>(model) || std::holds_alternative<Lighthouse2>(model)) {
    R << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // x forward, z up
  } else if (std::holds_alternative<Lighthouse2Full>(model)) {
    R << 1, 0, 0, 0, -1, 0, 0, 0, -1;  // looks along -z, y up
  }
  return R;
}

bool is_shown(const BodySample& sample) {
  return sample.status == BodyStatus::Tracked;
}

Eigen::AlignedBox3d box_of(const BodyRun& run) {
  Eigen::AlignedBox3d box;
  for (const LineDetector& detector : run.detectors) box.extend(centre_world(detector));
  for (const BodyTally& tally : run.tallies) {
    for (const BodySample& s : tally.samples.values()) {
      if (is_shown(s)) box.extend(s.T_world_body.translation());
    }
  }
  return box;
}

void add_detectors(const BodyRun& run, double size_m, Scene& scene) {
  std::map<std::string, Eigen::AlignedBox3d> stations;
  for (const LineDetector& detector : run.detectors) {
    CameraPyramid pyramid;
    pyramid.T_world_camera = detector.T_world_station * detector.T_station_detector;
    pyramid.T_world_camera.translation() = centre_world(detector);
    pyramid.T_world_camera.linear() *= R_model_view(detector.model);
    pyramid.colour = palette::kInk;
    pyramid.depth_m = size_m;
    // A line detector sees far to both sides of its focal line, and nothing of where along it.
    if (!std::holds_alternative<PixelAxis>(detector.model)) pyramid.half_extent = {0.55, 0.16};
    scene.cameras.push_back(pyramid);
    stations[detector.station].extend(centre_world(detector));
  }
  constexpr std::size_t kMostLabels = 24;
  if (stations.size() > kMostLabels) return;
  for (const auto& [name, box] : stations) {
    scene.labels.push_back({box.center() + Eigen::Vector3d(0, 0, 1.2 * size_m), name, palette::kInk});
  }
}

// The largest of 1, 3, 10, 30, ... standard deviations at which the typical ellipsoid is not larger than that.
double enlargement(const std::vector<const BodySample*>& samples, double most_m) {
  std::vector<double> sigmas;
  for (const BodySample* s : samples) sigmas.push_back(std::sqrt(s->covariance.topLeftCorner<3, 3>().trace()));
  const auto middle = sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 2);
  std::nth_element(sigmas.begin(), middle, sigmas.end());
  if (!(*middle > 0) || !std::isfinite(*middle)) return 1.0;
  const double decade = std::pow(10.0, std::floor(std::log10(most_m / *middle)));
  return std::max(1.0, 3.0 * decade * *middle <= most_m ? 3.0 * decade : decade);
}

void add_covariances(const BodyTally& tally, double size_m, const Rgb& colour, Scene& scene) {
  constexpr std::size_t kMost = 28;
  std::vector<const BodySample*> tracked;
  for (const BodySample& s : tally.samples.values()) {
    if (is_shown(s)) tracked.push_back(&s);
  }
  if (tracked.empty()) return;
  const double sigmas = enlargement(tracked, size_m);
  for (std::size_t k = 0; k < std::min(kMost, tracked.size()); ++k) {
    const BodySample& s = *tracked[k * tracked.size() / std::min(kMost, tracked.size())];
    const Eigen::Matrix3d R = s.T_world_body.linear();
    scene.translucent.push_back(covariance_ellipsoid(
        s.T_world_body.translation(), R * s.covariance.topLeftCorner<3, 3>() * R.transpose(), sigmas, colour));
  }
  scene.legend.push_back({fmt::format("position, {:g} standard deviations", sigmas), colour, PyramidStyle::Hollow});
}

ScenePath path_of(const BodyTally& tally, const Rgb& colour) {
  ScenePath path;
  path.colour = colour;
  for (const BodySample& s : tally.samples.values()) {
    path.points_world.push_back(is_shown(s) ? Eigen::Vector3d(s.T_world_body.translation())
                                            : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  }
  return path;
}

// The part of the reading's plane that lies between the detector and the marker, a little beyond it and to both sides.
std::optional<TranslucentSurface> plane_patch(const LineDetector& detector, double value,
                                              const Eigen::Vector3d& p_world) {
  const auto plane = plane_near(detector, value, p_world);
  if (!plane) return std::nullopt;
  const Eigen::Vector3d centre = centre_world(detector);
  const Eigen::Vector3d sight = 1.1 * (p_world - distance(*plane, p_world) * plane->normal - centre);
  const Eigen::Vector3d aside = 0.1 * plane->normal.cross(sight);
  TranslucentSurface patch;
  patch.vertices_world = {centre, centre + sight - aside, centre + sight + aside};
  patch.triangles = {{0, 1, 2}};
  patch.colour = palette::kEstimate;
  patch.opacity = 0.06;
  return patch;
}

void add_sights(const BodyRun& run, const RigidBody& body, const BodySnapshot& shown, const Rgb& colour, Scene& scene) {
  constexpr std::size_t kMostSights = 120;
  std::map<int, Eigen::Vector3d> p_world;
  for (const BodyMarker& marker : body.markers) {
    p_world[marker.id] = shown.state.T_world_body * marker.p_body;
    scene.points.push_back({p_world[marker.id], colour});
  }
  std::map<int, const LineDetector*> detectors;
  for (const LineDetector& detector : run.detectors) detectors[detector.id] = &detector;
  const std::size_t every = shown.readings.size() / kMostSights + 1;
  for (std::size_t i = 0; i < shown.readings.size(); ++i) {
    const LineReading& reading = shown.readings[i];
    const LineDetector& detector = *detectors.at(reading.detector);
    const Eigen::Vector3d& p = p_world.at(reading.marker);
    if (i % every == 0) scene.paths.push_back({{centre_world(detector), p}, kSight, 0.7});
    if (reading.marker != shown.readings.front().marker) continue;
    if (auto patch = plane_patch(detector, reading.value, p)) scene.translucent.push_back(*std::move(patch));
  }
}

}  // namespace

Scene scene_of(const BodyRun& run) {
  Scene scene;
  scene.up_world = Eigen::Vector3d::UnitZ();
  scene.point_size_px = 9.0;
  const Eigen::AlignedBox3d box = box_of(run);
  const double size_m = box.isEmpty() ? 0.1 : std::max(1e-3, 0.04 * box.diagonal().norm());
  add_detectors(run, size_m, scene);
  scene.legend.push_back({"detectors", palette::kInk, PyramidStyle::Hollow});
  for (std::size_t i = 0; i < run.bodies.size(); ++i) {
    const Rgb colour = curve_colour(i + 1);
    scene.legend.push_back({run.bodies[i].name, colour, PyramidStyle::Solid});
    scene.paths.push_back(path_of(run.tallies[i], colour));
    if (run.detail == PoseDetail::Motion) add_covariances(run.tallies[i], 0.35 * size_m, colour, scene);
    if (run.tallies[i].fullest) add_sights(run, run.bodies[i], *run.tallies[i].fullest, colour, scene);
  }
  return scene;
}

}  // namespace alidade
