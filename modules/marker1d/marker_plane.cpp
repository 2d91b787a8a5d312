// SPDX-License-Identifier: Apache-2.0
#include "marker1d/marker_plane.h"

#include <stdexcept>

#include <fmt/format.h>

#include "core/find_by_id.h"

namespace alidade {
namespace {

double sigma_of(const LineDetector& detector, const LineReading& reading) {
  const double sigma = reading.sigma > 0 ? reading.sigma : detector.sigma;
  if (!(sigma > 0)) throw std::invalid_argument(fmt::format("detector {}: sigma must be > 0", detector.id));
  return sigma;
}

std::optional<MarkerPlane> plane_anywhere(const LineDetector& detector, const LineReading& reading) {
  const auto plane = plane_of(detector, reading.value);
  if (!plane) return std::nullopt;
  const double sigma = sigma_of(detector, reading);
  return MarkerPlane{0, *plane, 1.0 / (sigma * sigma)};
}

}  // namespace

std::optional<MarkerPlane> plane_about(const LineDetector& detector, const LineReading& reading,
                                       const Eigen::Vector3d& p_world) {
  const auto projection = project(detector, p_world);
  const auto plane = plane_near(detector, reading.value, p_world);
  if (!projection || !plane) return std::nullopt;
  const double sigma = sigma_of(detector, reading);
  return MarkerPlane{0, *plane, projection->J_value_point.squaredNorm() / (sigma * sigma)};
}

std::vector<MarkerPlane> marker_planes(std::span<const LineDetector> detectors, const RigidBody& body,
                                       std::span<const LineReading> readings,
                                       const std::optional<Eigen::Isometry3d>& T_world_body_predicted) {
  std::vector<MarkerPlane> planes;
  planes.reserve(readings.size());
  for (const LineReading& reading : readings) {
    const BodyMarker* marker = find_by_id<BodyMarker>(body.markers, reading.marker);
    if (marker == nullptr) continue;
    const LineDetector* detector = find_by_id(detectors, reading.detector);
    if (detector == nullptr) throw std::invalid_argument(fmt::format("there is no detector {}", reading.detector));
    auto plane = T_world_body_predicted ? plane_about(*detector, reading, *T_world_body_predicted * marker->p_body)
                                        : plane_anywhere(*detector, reading);
    if (!plane) continue;
    plane->marker = static_cast<int>(marker - body.markers.data());
    planes.push_back(*plane);
  }
  return planes;
}

}  // namespace alidade
