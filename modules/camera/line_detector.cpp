// SPDX-License-Identifier: Apache-2.0
#include "camera/line_detector.h"

#include <cmath>
#include <numbers>

#include "camera/laser_sweep.h"

namespace alidade {
namespace {

using Eigen::Vector3d;

constexpr double kLeastDepth = 1e-9;  // m
constexpr int kMostSteps = 12;        // Newton's; three are usual

template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

// A line camera reads as a camera does of points in its plane y = 0; the image's height plays no part.
Camera flat_camera(const LineCamera& m) {
  return {m.width, 1, m.f, m.f, m.c, 0.0, BrownConrady{m.k1, m.k2, 0.0, 0.0, m.k3}, 0.0};
}

std::optional<LineProjection> project_focal_line(const Vector3d& p) {
  if (!(p.z() > kLeastDepth)) return std::nullopt;
  const double r2 = p.x() * p.x() + p.z() * p.z();
  return LineProjection{std::atan2(p.x(), p.z()), Eigen::RowVector3d(p.z(), 0.0, -p.x()) / r2};
}

std::optional<LineProjection> project_axis(const Camera& camera, int axis, const Vector3d& p) {
  const auto projection = project(camera, p);
  if (!projection) return std::nullopt;
  return LineProjection{projection->pixel[axis], projection->J_pixel_point.row(axis)};
}

// Readings do not depend on the distance, so that every plane of a model passes through its frame's origin.
Plane plane_through_origin(const LineProjection& projection) {
  return {projection.J_value_point.transpose().normalized(), 0.0};
}

// The half plane in front of the detector in which a model's axis points lie: elevation 0 of a laser sweep, the line of
// pixels, a row or column through a camera's principal point. Angles count from `forward` towards `side`.
struct Axis {
  Vector3d forward, side;
};

Axis axis_of(const LineModel& model) {
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const auto lens = [&](const auto&) { return Axis{z, x}; };
  const auto pixel = [&](const PixelAxis& m) { return Axis{z, m.axis == 0 ? x : y}; };
  const auto first = [&](const Lighthouse1& m) { return Axis{x, m.sweep == 0 ? y : z}; };
  const auto second = [&](const Lighthouse2&) { return Axis{x, y}; };
  const auto full = [&](const Lighthouse2Full&) { return Axis{-z, -x}; };
  return std::visit(Overloaded{lens, pixel, first, second, full}, model);
}

// The point of a sweep's axis that is read at `value`: the factory terms are small, Newton starts from the value
// itself.
std::optional<Vector3d> sweep_point(const LineModel& model, double value) {
  const Axis axis = axis_of(model);
  double a = value;
  for (int i = 0; i < kMostSteps; ++i) {
    const Vector3d p = std::cos(a) * axis.forward + std::sin(a) * axis.side;
    const Vector3d slope = std::cos(a) * axis.side - std::sin(a) * axis.forward;
    const auto projection = project(model, p);
    if (!projection) return std::nullopt;
    const double step = residual(model, value, projection->value) / (projection->J_value_point * slope);
    if (std::abs(step) < 1e-14) return p;
    a += step;
  }
  return std::nullopt;
}

// A point on the model's axis that is read at `value`.
std::optional<Vector3d> axis_point(const LineModel& model, double value) {
  if (!std::isfinite(value)) return std::nullopt;
  const auto sweep = [&](const auto&) { return sweep_point(model, value); };
  const auto line_camera = [&](const LineCamera& m) { return unproject(flat_camera(m), {value, 0.0}); };
  const auto pixel = [&](const PixelAxis& m) {
    const Camera& c = m.camera;
    return unproject(c, m.axis == 0 ? Eigen::Vector2d(value, c.cy) : Eigen::Vector2d(c.cx, value));
  };
  return std::visit(Overloaded{line_camera, pixel, sweep}, model);
}

// The point nearest to p_near that is read at `value`, to first order; the readings along the gradient are almost
// linear. Empty where Newton does not arrive: the reading is too far from the point to be its.
std::optional<LineProjection> projection_on_surface(const LineModel& model, double value, Vector3d p,
                                                    LineProjection projection) {
  for (int i = 0; i < kMostSteps; ++i) {
    const double error = residual(model, value, projection.value);
    const double slope2 = projection.J_value_point.squaredNorm();
    const Vector3d step = projection.J_value_point.transpose() * (error / slope2);
    if (step.squaredNorm() < 1e-24 * p.squaredNorm()) return projection;
    p += step;
    const auto moved = project(model, p);
    if (!moved) return std::nullopt;
    projection = *moved;
  }
  return std::nullopt;
}

Eigen::Isometry3d detector_pose(const LineDetector& detector) {
  return detector.T_world_station * detector.T_station_detector;
}

bool has_exact_planes(const LineModel& model) {
  return std::holds_alternative<FocalLine>(model) || std::holds_alternative<LineCamera>(model);
}

}  // namespace

std::optional<LineProjection> project(const LineModel& model, const Vector3d& p) {
  if (!p.allFinite()) return std::nullopt;
  const auto focal_line = [&](const FocalLine&) { return project_focal_line(p); };
  const auto line_camera = [&](const LineCamera& m) { return project_axis(flat_camera(m), 0, {p.x(), 0.0, p.z()}); };
  const auto pixel = [&](const PixelAxis& m) { return project_axis(m.camera, m.axis, p); };
  const auto sweep = [&](const auto& m) { return project_sweep(m, p); };
  return std::visit(Overloaded{focal_line, line_camera, pixel, sweep}, model);
}

std::optional<LineProjection> project(const LineDetector& detector, const Vector3d& p_world) {
  const Eigen::Isometry3d T_world_detector = detector_pose(detector);
  auto projection = project(
      detector.model, Vector3d(T_world_detector.linear().transpose() * (p_world - T_world_detector.translation())));
  if (projection) projection->J_value_point *= T_world_detector.linear().transpose();
  return projection;
}

std::optional<Plane> plane_near(const LineDetector& detector, double value, const Vector3d& near_world) {
  const Eigen::Isometry3d T_world_detector = detector_pose(detector);
  const Vector3d p = T_world_detector.linear().transpose() * (near_world - T_world_detector.translation());
  const auto near = project(detector.model, p);
  if (!near || !std::isfinite(value)) return std::nullopt;
  if (has_exact_planes(detector.model)) return plane_of(detector, value);
  if (const auto on_surface = projection_on_surface(detector.model, value, p, *near)) {
    return T_world_detector * plane_through_origin(*on_surface);
  }
  const double slope = near->J_value_point.norm();
  const Vector3d normal = near->J_value_point.transpose() / slope;
  return T_world_detector * Plane{normal, normal.dot(p) + residual(detector.model, value, near->value) / slope};
}

std::optional<Plane> plane_of(const LineDetector& detector, double value) {
  const auto p = axis_point(detector.model, value);
  const auto projection = p ? project(detector.model, *p) : std::nullopt;
  if (!projection) return std::nullopt;
  return detector_pose(detector) * plane_through_origin(*projection);
}

std::optional<double> value_of(const LineDetector& detector, const Plane& plane_world) {
  const Vector3d normal = detector_pose(detector).linear().transpose() * plane_world.normal;
  const Axis axis = axis_of(detector.model);
  const double along = normal.dot(axis.forward), across = normal.dot(axis.side);
  if (!(std::hypot(along, across) > 1e-9)) return std::nullopt;  // the plane holds every axis point, or is none
  const Vector3d p = across < 0 ? Vector3d(along * axis.side - across * axis.forward)
                                : Vector3d(across * axis.forward - along * axis.side);
  const auto projection = project(detector.model, p);
  if (!projection) return std::nullopt;
  return projection->value;
}

bool reads_pixels(const LineModel& model) {
  return std::holds_alternative<LineCamera>(model) || std::holds_alternative<PixelAxis>(model);
}

double residual(const LineModel& model, double value, double expected) {
  const double difference = value - expected;
  return reads_pixels(model) ? difference : std::remainder(difference, 2.0 * std::numbers::pi);
}

Vector3d centre_world(const LineDetector& detector) {
  return detector_pose(detector).translation();
}

}  // namespace alidade
