// SPDX-License-Identifier: Apache-2.0
#include "app/body_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "app/detector_scene.h"

namespace alidade {
namespace {

constexpr Rgb kSight{176, 180, 190};

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

// How many times a typical ellipsoid is enlarged.
double typical_enlargement(const std::vector<const BodySample*>& samples, double most_m) {
  std::vector<double> sigmas;
  for (const BodySample* s : samples) sigmas.push_back(std::sqrt(s->covariance.topLeftCorner<3, 3>().trace()));
  const auto middle = sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 2);
  std::nth_element(sigmas.begin(), middle, sigmas.end());
  return enlargement(*middle, most_m);
}

void add_covariances(const BodyTally& tally, double size_m, const Rgb& colour, Scene& scene) {
  constexpr std::size_t kMost = 28;
  std::vector<const BodySample*> tracked;
  for (const BodySample& s : tally.samples.values()) {
    if (is_shown(s)) tracked.push_back(&s);
  }
  if (tracked.empty()) return;
  const double sigmas = typical_enlargement(tracked, size_m);
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
  add_detectors(run.detectors, {size_m, palette::kInk, true}, scene);
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
