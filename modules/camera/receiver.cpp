// SPDX-License-Identifier: Apache-2.0
#include "camera/receiver.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/LU>
#include <fmt/format.h>

#include "camera/rolling_shutter.h"
#include "core/find_by_id.h"
#include "geometry/tangent.h"

namespace alidade {
namespace {

struct Direction {
  Eigen::Vector3d d_receiver;
  Eigen::Matrix<double, 3, 2> J_direction_value;  // across the direction
};

// Of a pixel; the derivative is the inverse of the projection's across the ray.
std::optional<Direction> direction_of_pixel(const Camera& camera, const Eigen::Vector2d& pixel) {
  const auto d = unproject(camera, pixel);
  if (!d) return std::nullopt;
  const auto projection = project(camera, *d);
  if (!projection) return std::nullopt;
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(*d);
  const Eigen::Matrix2d J_pixel_tangent = projection->J_pixel_point * basis;
  return Direction{*d, basis * J_pixel_tangent.inverse()};
}

// Which way elevation goes along y.
double sign_of_y(FinderAxes axes) {
  return axes == FinderAxes::YUp ? 1.0 : -1.0;
}

Direction direction_of_finder(const Eigen::Vector2d& angles, FinderAxes axes) {
  const double ca = std::cos(angles[0]), sa = std::sin(angles[0]), ce = std::cos(angles[1]), se = std::sin(angles[1]);
  Direction direction{direction_of_angles(angles, axes), {}};
  direction.J_direction_value << ca * ce, -sa * se,  //
      0.0, sign_of_y(axes) * ce,                     //
      -sa * ce, -ca * se;
  return direction;
}

}  // namespace

Timestamp common_time(const ReceiverClock& clock, Timestamp own) {
  return own + from_seconds(clock.offset_s + clock.rate * to_seconds(own - clock.reference));
}

Timestamp own_time(const ReceiverClock& clock, Timestamp common) {
  const double since_s = (to_seconds(common - clock.reference) - clock.offset_s) / (1.0 + clock.rate);
  return clock.reference + from_seconds(since_s);
}

std::optional<std::string> find_fault(const Receiver& receiver) {
  if (receiver.camera) {
    if (auto fault = find_fault(*receiver.camera)) return fault;
  }
  const char* unit = receiver.camera ? "px" : "rad";
  if (!(receiver.sigma > 0.0) || !std::isfinite(receiver.sigma)) {
    return fmt::format("sigma must be > 0 {}, got {}", unit, receiver.sigma);
  }
  if (!receiver.camera && receiver.sigma > 0.5) {
    return fmt::format("sigma of a direction finder must be <= 0.5 rad, got {}: are these degrees?", receiver.sigma);
  }
  if (!(std::abs(receiver.clock.rate) < 0.01)) {
    return fmt::format("the clock's rate must be within 0.01 s/s, got {}", receiver.clock.rate);
  }
  return std::nullopt;
}

Eigen::Vector3d direction_of_angles(const Eigen::Vector2d& azimuth_elevation, FinderAxes axes) {
  const double azimuth = azimuth_elevation[0], elevation = azimuth_elevation[1];
  return {std::cos(elevation) * std::sin(azimuth), sign_of_y(axes) * std::sin(elevation),
          std::cos(elevation) * std::cos(azimuth)};
}

Eigen::Vector2d angles_of_direction(const Eigen::Vector3d& d_receiver, FinderAxes axes) {
  return {std::atan2(d_receiver.x(), d_receiver.z()),
          std::asin(std::clamp(sign_of_y(axes) * d_receiver.y(), -1.0, 1.0))};
}

std::optional<Bearing> bearing_of(const Receiver& receiver, const ReceiverReading& reading) {
  if (reading.receiver != receiver.id) throw std::invalid_argument("bearing_of: the reading is of another receiver");
  const std::optional<Direction> seen = receiver.camera ? direction_of_pixel(*receiver.camera, reading.value)
                                                        : direction_of_finder(reading.value, receiver.axes);
  if (!seen) return std::nullopt;
  const Eigen::Matrix3d R_world_receiver = receiver.T_world_receiver.linear();
  const Eigen::Vector3d d_world = (R_world_receiver * seen->d_receiver).normalized();
  Bearing bearing;
  bearing.time = common_time(receiver.clock, reading.time);
  if (receiver.camera) bearing.time += from_seconds(row_time_s(*receiver.camera, reading.value.y()));
  bearing.receiver = receiver.id;
  bearing.origin_world = receiver.T_world_receiver.translation();
  bearing.direction_world = d_world;
  bearing.temperature_k = reading.temperature_k;
  bearing.target = reading.target;
  const double variance = receiver.sigma * receiver.sigma;
  if (!receiver.camera && reading.covariance.isZero(0.0)) {
    bearing.covariance = variance * Eigen::Matrix2d::Identity();
    return bearing;
  }
  const Eigen::Matrix2d J = tangent_basis(d_world).transpose() * R_world_receiver * seen->J_direction_value;
  const Eigen::Matrix2d noise =
      reading.covariance.isZero(0.0) ? Eigen::Matrix2d(variance * Eigen::Matrix2d::Identity()) : reading.covariance;
  bearing.covariance = J * noise * J.transpose();
  return bearing;
}

std::vector<Bearing> bearings_of(std::span<const Receiver> receivers, std::span<const ReceiverReading> readings) {
  std::vector<Bearing> bearings;
  bearings.reserve(readings.size());
  for (const ReceiverReading& reading : readings) {
    const Receiver* receiver = find_by_id(receivers, reading.receiver);
    if (!receiver) throw std::invalid_argument(fmt::format("bearings_of: no receiver has the id {}", reading.receiver));
    if (const auto bearing = bearing_of(*receiver, reading)) bearings.push_back(*bearing);
  }
  std::stable_sort(bearings.begin(), bearings.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return bearings;
}

std::optional<ReceiverReading> reading_of(const Receiver& receiver, const Eigen::Vector3d& p_world, Timestamp common) {
  const Eigen::Vector3d p_receiver = receiver.T_world_receiver.inverse() * p_world;
  ReceiverReading reading;
  reading.time = own_time(receiver.clock, common);
  reading.receiver = receiver.id;
  if (!receiver.camera) {
    reading.value = angles_of_direction(p_receiver.normalized(), receiver.axes);
    return reading;
  }
  const auto projection = project(*receiver.camera, p_receiver);
  if (!projection || !is_inside(*receiver.camera, projection->pixel)) return std::nullopt;
  reading.value = projection->pixel;
  return reading;
}

}  // namespace alidade
