// SPDX-License-Identifier: Apache-2.0
#include "uav/tracker/bearing_filter.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/LU>
#include <fmt/format.h>

#include "geometry/tangent.h"

namespace alidade {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix23d = Eigen::Matrix<double, 2, 3>;
using Matrix92d = Eigen::Matrix<double, 9, 2>;

void add_block(Matrix9d& Q, int row, int column, double variance) {
  Q.block<3, 3>(row, column).diagonal().array() += variance;
  if (row != column) Q.block<3, 3>(column, row).diagonal().array() += variance;
}

// Tangents of the angles from the bearing's direction to a point, and how they change with it; linear over depth.
struct Projection {
  Vector2d tangents;
  Matrix23d J_p;
};

std::optional<Projection> project(const Eigen::Matrix<double, 3, 2>& basis, const Bearing& bearing,
                                  const Vector3d& p_world) {
  const Vector3d sight = p_world - bearing.origin_world;
  const double depth = bearing.direction_world.dot(sight);
  if (!(depth > 0.0)) return std::nullopt;
  Projection projection;
  projection.tangents = basis.transpose() * sight / depth;
  projection.J_p = (basis.transpose() - projection.tangents * bearing.direction_world.transpose()) / depth;
  return projection;
}

Matrix2d noise_of(const Bearing& bearing, double added_sigma_rad) {
  return bearing.covariance + added_sigma_rad * added_sigma_rad * Matrix2d::Identity();
}

void add(TargetState& state, const Vector9d& step) {
  state.p_world += step.head<3>();
  state.v_world += step.segment<3>(3);
  state.a_world += step.tail<3>();
}

}  // namespace

void validate(const BearingFilterOptions& options) {
  const auto require = [](bool holds, const char* field, double value, const char* bound) {
    if (!holds) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
  };
  require(options.motion.acceleration_density >= 0.0, "acceleration_density", options.motion.acceleration_density,
          ">= 0 m^2/s^3");
  require(options.motion.jerk_density >= 0.0, "jerk_density", options.motion.jerk_density, ">= 0 m^2/s^5");
  require(options.added_sigma_rad >= 0.0, "added_sigma_rad", options.added_sigma_rad, ">= 0 rad");
  require(options.max_iterations >= 1, "max_iterations", options.max_iterations, ">= 1");
}

// White noise held over no time: Bar-Shalom, Li, Kirubarajan 2001, eqs. 6.2.2-4 and 6.2.3-7.
TargetState predict(const TargetState& state, Timestamp time, const TargetMotion& motion) {
  TargetState predicted = moved_to(state, time);
  const double t = to_seconds(time - state.time);
  if (!(t > 0.0)) return predicted;
  const double q = motion.acceleration_density, j = motion.jerk_density;
  Matrix9d& P = predicted.covariance;
  if (q > 0.0) {
    add_block(P, 0, 0, q * t * t * t / 3.0);
    add_block(P, 0, 3, q * t * t / 2.0);
    add_block(P, 3, 3, q * t);
  }
  if (j > 0.0) {
    add_block(P, 0, 0, j * std::pow(t, 5) / 20.0);
    add_block(P, 0, 3, j * std::pow(t, 4) / 8.0);
    add_block(P, 0, 6, j * t * t * t / 6.0);
    add_block(P, 3, 3, j * t * t * t / 3.0);
    add_block(P, 3, 6, j * t * t / 2.0);
    add_block(P, 6, 6, j * t);
  }
  return predicted;
}

std::optional<BearingInnovation> innovation_of(const TargetState& predicted, const Bearing& bearing,
                                               double added_sigma_rad) {
  const auto seen = project(tangent_basis(bearing.direction_world), bearing, predicted.p_world);
  if (!seen) return std::nullopt;
  BearingInnovation innovation;
  innovation.residual = seen->tangents;
  innovation.J_residual_p = seen->J_p;
  innovation.with_state = predicted.covariance.leftCols<3>() * seen->J_p.transpose();
  innovation.covariance = seen->J_p * innovation.with_state.topRows<3>() + noise_of(bearing, added_sigma_rad);
  innovation.chi2 = innovation.residual.dot(innovation.covariance.inverse() * innovation.residual);
  innovation.log_density =
      -0.5 * innovation.chi2 - 0.5 * std::log(innovation.covariance.determinant()) - std::log(2.0 * std::numbers::pi);
  return innovation;
}

// The bearing itself is the origin of the tangents: it measures (0, 0).
TargetState absorb(const TargetState& predicted, const Bearing& bearing, const BearingInnovation& innovation,
                   const BearingFilterOptions& options) {
  constexpr double kSettled = 1e-3;  // of the range: what a step may change before the tangents bend
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(bearing.direction_world);
  const Matrix2d R = noise_of(bearing, options.added_sigma_rad);
  Matrix23d J = innovation.J_residual_p;
  Matrix92d K = innovation.with_state * innovation.covariance.inverse();
  Vector9d step = -K * innovation.residual;
  for (int i = 1; i < options.max_iterations; ++i) {
    const double range = (predicted.p_world - bearing.origin_world).norm();
    if (step.head<3>().norm() < kSettled * range) break;
    const auto seen = project(basis, bearing, predicted.p_world + step.head<3>());
    if (!seen) break;
    J = seen->J_p;
    const Matrix92d with_state = predicted.covariance.leftCols<3>() * J.transpose();
    K = with_state * (J * with_state.topRows<3>() + R).inverse();
    const Vector9d next = -K * (seen->tangents - J * step.head<3>());
    const double change = (next - step).head<3>().norm();
    step = next;
    if (change < 1e-3 * kSettled * range) break;
  }
  TargetState state = predicted;
  add(state, step);
  Matrix9d A = Matrix9d::Identity();
  A.leftCols<3>() -= K * J;
  const Matrix9d left = A * predicted.covariance;
  state.covariance.noalias() = left * A.transpose() + K * R * K.transpose();
  return state;
}

TargetState filter_bearings(TargetState state, std::span<const Bearing> bearings, const BearingFilterOptions& options) {
  for (const Bearing& bearing : bearings) {
    const TargetState predicted = predict(state, bearing.time, options.motion);
    const auto innovation = innovation_of(predicted, bearing, options.added_sigma_rad);
    state = innovation ? absorb(predicted, bearing, *innovation, options) : predicted;
  }
  return state;
}

}  // namespace alidade
