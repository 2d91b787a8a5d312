// SPDX-License-Identifier: Apache-2.0
#include "marker1d/body_residuals.h"

#include <stdexcept>

#include <fmt/format.h>

#include "core/find_by_id.h"
#include "geometry/rotation.h"

namespace alidade {
namespace {

const BodyMarker& marker_of(const RigidBody& body, int id) {
  if (const BodyMarker* marker = find_by_id(std::span(body.markers), id)) return *marker;
  throw std::invalid_argument(fmt::format("body '{}' has no marker {}", body.name, id));
}

Eigen::Isometry3d pose_at(const MotionState& state, Timestamp time) {
  const double dt = to_seconds(time - state.time);
  Eigen::Isometry3d T_world_body = state.T_world_body;
  if (dt == 0.0) return T_world_body;
  T_world_body.translation() += dt * (state.v_world + 0.5 * dt * state.a_world);
  T_world_body.linear() *= exp_so3(dt * (state.omega_body + 0.5 * dt * state.alpha_body));
  return T_world_body;
}

}  // namespace

std::vector<std::optional<ReadingResidual>> residuals_of(const DetectorArray& detectors, const RigidBody& body,
                                                         std::span<const LineReading> readings,
                                                         const MotionState& state) {
  std::vector<std::optional<ReadingResidual>> residuals;
  for (const LineReading& r : readings) {
    const DetectorArray::Entry& entry = detectors.at(r.detector);
    const LineDetector& detector = entry.detector;
    const Eigen::Vector3d p_world = pose_at(state, r.time) * marker_of(body, r.marker).p_body;
    const auto expected = project(detector.model, entry.T_detector_world * p_world);
    residuals.emplace_back();
    if (!expected) continue;
    residuals.back() = {residual(detector.model, r.value, expected->value), r.sigma > 0 ? r.sigma : detector.sigma};
  }
  return residuals;
}

}  // namespace alidade
