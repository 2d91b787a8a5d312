// SPDX-License-Identifier: Apache-2.0
#include "geometry/rotation_descent.h"

#include <algorithm>
#include <cmath>

namespace alidade {
namespace {

// R times the rotation with half-angle tangent phi / 2: equal to exp(phi) to second order, all that Newton needs.
Eigen::Matrix3d turned(const Eigen::Matrix3d& R, const Eigen::Vector3d& phi) {
  const Eigen::Vector3d h = 0.5 * phi;
  const double k = 2.0 / (1.0 + h.squaredNorm());
  Eigen::Matrix3d T;
  T << -h.y() * h.y() - h.z() * h.z(), h.x() * h.y() - h.z(), h.x() * h.z() + h.y(),  //
      h.x() * h.y() + h.z(), -h.x() * h.x() - h.z() * h.z(), h.y() * h.z() - h.x(),   //
      h.x() * h.z() - h.y(), h.y() * h.z() + h.x(), -h.x() * h.x() - h.y() * h.y();
  return R + k * (R * T);
}

// H⁻¹ b; empty unless all pivots exceed the share `least` of H's mean diagonal.
std::optional<Eigen::Vector3d> solve_positive(const Eigen::Matrix3d& H, const Eigen::Vector3d& b, double least) {
  const double bound = least * (H(0, 0) + H(1, 1) + H(2, 2));
  const double d0 = H(0, 0);
  if (!(d0 > bound)) return std::nullopt;
  const double l10 = H(1, 0) / d0, l20 = H(2, 0) / d0;
  const double d1 = H(1, 1) - l10 * H(1, 0);
  if (!(d1 > bound)) return std::nullopt;
  const double e21 = H(2, 1) - l20 * H(1, 0);
  const double l21 = e21 / d1;
  const double d2 = H(2, 2) - l20 * H(2, 0) - l21 * e21;
  if (!(d2 > bound)) return std::nullopt;
  const double y1 = b(1) - l10 * b(0);
  const double y2 = b(2) - l20 * b(0) - l21 * y1;
  Eigen::Vector3d x;
  x(2) = y2 / d2;
  x(1) = y1 / d1 - l21 * x(2);
  x(0) = b(0) / d0 - l10 * x(1) - l20 * x(2);
  return x;
}

constexpr double kLeastPivot = 1e-13;  // a share of the trace; below it a rotation is not determined
// Valleys are narrow and bent: a step along the floor ends on the wall. The damping of the step that leads back to the
// floor lies between the curvatures along and across; a step that fails nevertheless is damped from kLeastDamping on.
constexpr double kBackToFloor = 0.1, kLeastDamping = 1e-4;
constexpr double kLongestStep = 1.0;  // rad; beyond it a quadratic model of a rotation is none

std::optional<Eigen::Vector3d> newton_step(const RotationSlope& at) {
  return solve_positive(at.hessian, -at.gradient, kLeastPivot);
}

// A step downhill from anywhere, and no longer than kLongestStep; `damping` in shares of the mean curvature.
Eigen::Vector3d damped_step(const RotationSlope& at, double damping) {
  const double mean = at.gauss_newton.trace() / 3.0;
  Eigen::Matrix3d H = at.hessian;
  H.diagonal().array() += damping * mean;
  std::optional<Eigen::Vector3d> step = solve_positive(H, -at.gradient, kLeastPivot);
  if (!step) {
    H = at.gauss_newton;
    H.diagonal().array() += (damping + 1e-3) * mean;
    step = solve_positive(H, -at.gradient, kLeastPivot);
  }
  if (!step) return Eigen::Vector3d::Zero();
  const double length = step->norm();
  return length > kLongestStep ? Eigen::Vector3d(*step * (kLongestStep / length)) : *step;
}

}  // namespace

RotationSlope slope(const RotationCost& cost, const Eigen::Matrix3d& R) {
  // G [e_j]-blocks times R: V[j] holds G's block column j times r_0, r_1, r_2. From it G a = Σ_j V[j].col(j), and the
  // derivative of a along φ_i is the pair of columns of R that [e_i]× exchanges.
  using Columns = Eigen::Matrix<double, 9, 3>;
  Columns V[3];
  for (int j = 0; j < 3; ++j) V[j].noalias() = cost.G.middleCols<3>(3 * j).lazyProduct(R);
  Vector9d Ga = V[0].col(0) + V[1].col(1) + V[2].col(2);
  Vector9d rest = Ga - cost.g;
  const Eigen::Matrix3d Z = R.transpose() * Eigen::Map<const Eigen::Matrix3d>(rest.data());

  RotationSlope at;
  const Eigen::Map<const Vector9d> a(R.data());
  at.half_cost = 0.5 * (a.dot(rest) - a.dot(cost.g) + cost.h);
  at.gradient << Z(2, 1) - Z(1, 2), Z(0, 2) - Z(2, 0), Z(1, 0) - Z(0, 1);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const Vector9d GD = V[j].col(k) - V[k].col(j);
    for (int m = 0; m <= i; ++m) {
      const int n = (m + 1) % 3, o = (m + 2) % 3;
      at.gauss_newton(i, m) = R.col(o).dot(GD.segment<3>(3 * n)) - R.col(n).dot(GD.segment<3>(3 * o));
      at.gauss_newton(m, i) = at.gauss_newton(i, m);
    }
  }
  at.hessian = at.gauss_newton + 0.5 * (Z + Z.transpose());
  at.hessian.diagonal().array() -= Z.trace();
  return at;
}

std::optional<Eigen::Matrix3d> newton_rotation(const RotationCost& cost, const Eigen::Matrix3d& start,
                                               double last_step) {
  constexpr int kMaxSteps = 10;
  Eigen::Matrix3d R = start;
  for (int step = 0; step < kMaxSteps; ++step) {
    const std::optional<Eigen::Vector3d> phi = newton_step(slope(cost, R));
    if (!phi) return std::nullopt;
    R = turned(R, *phi);
    const double squared = phi->squaredNorm();
    if (squared < last_step * last_step) return R;
    if (!(squared < kLongestStep * kLongestStep)) return std::nullopt;
  }
  return std::nullopt;
}

RotationMinimum descend(const RotationCost& cost, const Eigen::Matrix3d& start, const RotationDescentOptions& options) {
  RotationMinimum result{start, 0.0, Eigen::Matrix3d::Zero(), 0, false};
  RotationSlope at = slope(cost, start);
  const double rounding = 1e-15 * (std::abs(cost.h) + cost.G.trace());  // E is known no better
  double damping = 0.0;
  while (result.steps < options.max_steps && !result.is_minimum) {
    const Eigen::Vector3d phi = damped_step(at, damping);
    result.is_minimum = phi.norm() < options.last_step;
    Eigen::Matrix3d R = turned(result.R_world_body, phi);
    RotationSlope there = slope(cost, R);
    ++result.steps;
    if (there.half_cost > at.half_cost + rounding && !result.is_minimum) {
      R = turned(R, damped_step(there, kBackToFloor));
      there = slope(cost, R);
      ++result.steps;
    }
    const bool is_lower = there.half_cost <= at.half_cost + rounding;
    damping = is_lower ? (damping > kLeastDamping ? 0.1 * damping : 0.0) : std::max(kLeastDamping, 10.0 * damping);
    if (!is_lower) continue;
    result.R_world_body = R;
    at = there;
  }
  result.cost = 2.0 * at.half_cost;
  result.hessian = at.hessian;
  return result;
}

}  // namespace alidade
