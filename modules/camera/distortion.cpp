// SPDX-License-Identifier: Apache-2.0
#include "camera/distortion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace alidade {
namespace {

using Jacobian = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMostCoefficients>;

// Numerator and denominator of the radial factor and their derivatives by s = r².
struct RadialFactor {
  double n, d, dn, dd;
  double value() const { return n / d; }
  double slope() const { return (dn * d - n * dd) / (d * d); }
};

RadialFactor radial_factor(const BrownConrady& k, double s) {
  return {1.0 + s * (k.k1 + s * (k.k2 + s * k.k3)), 1.0 + s * (k.k4 + s * (k.k5 + s * k.k6)),
          k.k1 + s * (2.0 * k.k2 + s * 3.0 * k.k3), k.k4 + s * (2.0 * k.k5 + s * 3.0 * k.k6)};
}

bool has_denominator(const BrownConrady& k) {
  return k.k4 != 0 || k.k5 != 0 || k.k6 != 0;
}

struct PlanePoint {
  Eigen::Vector2d xy;
  Eigen::Matrix2d J;  // ∂distorted/∂undistorted
};

PlanePoint distort_plane(const BrownConrady& k, const Eigen::Vector2d& xy) {
  const double x = xy.x(), y = xy.y();
  const double r2 = x * x + y * y;
  const RadialFactor factor = radial_factor(k, r2);
  const double radial = factor.value();
  const double slope = 2.0 * factor.slope();  // ∂radial/∂x = slope x
  PlanePoint d;
  d.xy = {x * radial + 2.0 * k.p1 * x * y + k.p2 * (r2 + 2.0 * x * x),
          y * radial + 2.0 * k.p2 * x * y + k.p1 * (r2 + 2.0 * y * y)};
  const double cross = slope * x * y + 2.0 * k.p1 * x + 2.0 * k.p2 * y;
  d.J << radial + slope * x * x + 2.0 * k.p1 * y + 6.0 * k.p2 * x, cross, cross,
      radial + slope * y * y + 2.0 * k.p2 * x + 6.0 * k.p1 * y;
  return d;
}

DistortedPoint distort_point(const BrownConrady& k, const Eigen::Vector3d& p) {
  const Eigen::Vector2d xy = p.head<2>() / p.z();
  Eigen::Matrix<double, 2, 3> J_plane_point;
  J_plane_point << 1, 0, -xy.x(), 0, 1, -xy.y();
  J_plane_point /= p.z();
  const PlanePoint d = distort_plane(k, xy);
  return {d.xy, d.J * J_plane_point};
}

// Beyond the first radius where the polynomial stops growing, two directions share a pixel. Its slope
// 1 + a s + b s² + c s³ (s = r²) is least at the end of [0, r2] or where 3c s² + 2b s + a = 0.
bool polynomial_folds_back(const BrownConrady& k, double r2) {
  const double a = 3.0 * k.k1, b = 5.0 * k.k2, c = 7.0 * k.k3;
  const auto grows_at = [&](double s) { return 1.0 + s * (a + s * (b + s * c)) > 0; };
  if (!grows_at(r2)) return true;
  const double discriminant = b * b - 3.0 * a * c;
  if (discriminant < 0) return false;
  // The minimum of the cubic, in the form that does not cancel; c = 0 leaves a parabola.
  const double root = std::sqrt(discriminant);
  const double least = b + root > 0 ? -a / (b + root) : (c != 0 ? (root - b) / (3.0 * c) : 0.0);
  return least > 0 && least < r2 && !grows_at(least);
}

// The slope of r N/D has the sign of N D + 2 s (N' D - N D'), a polynomial of degree 6; looked at on a grid.
bool quotient_folds_back(const BrownConrady& k, double r2) {
  constexpr int kSteps = 24;
  for (int i = 1; i <= kSteps; ++i) {
    const double s = r2 * i / kSteps;
    const RadialFactor f = radial_factor(k, s);
    if (!(f.d > 0) || !(f.n * f.d + 2.0 * s * (f.dn * f.d - f.n * f.dd) > 0)) return true;
  }
  return false;
}

bool folds(const BrownConrady& k, const Eigen::Vector3d& p) {
  const double r2 = p.head<2>().squaredNorm() / (p.z() * p.z());
  return has_denominator(k) ? quotient_folds_back(k, r2) : polynomial_folds_back(k, r2);
}

std::optional<Eigen::Vector3d> direction_at(const BrownConrady& k, const Eigen::Vector2d& target) {
  if (k == BrownConrady{}) return target.homogeneous().normalized();
  Eigen::Vector2d xy = target;
  for (int i = 0; i < 20; ++i) {
    const PlanePoint d = distort_plane(k, xy);
    const Eigen::Vector2d error = target - d.xy;
    if (error.squaredNorm() < 1e-24) break;
    if (!(std::abs(d.J.determinant()) > 1e-6)) return std::nullopt;
    Eigen::Vector2d step = d.J.inverse() * error;
    const double longest = 0.3;  // a Newton step beyond it has left the basin of the image
    if (step.norm() > longest) step *= longest / step.norm();
    xy += step;
  }
  if (!((distort_plane(k, xy).xy - target).norm() < 1e-9) || folds(k, xy.homogeneous())) return std::nullopt;
  return xy.homogeneous().normalized();
}

struct FisheyeRadius {
  double value, slope;  // θ_d and ∂θ_d/∂θ
};

FisheyeRadius fisheye_radius(const Fisheye& k, double theta) {
  const double s = theta * theta;
  return {theta * (1.0 + s * (k.k1 + s * (k.k2 + s * (k.k3 + s * k.k4)))),
          1.0 + s * (3.0 * k.k1 + s * (5.0 * k.k2 + s * (7.0 * k.k3 + s * 9.0 * k.k4)))};
}

double off_axis_angle(const Eigen::Vector3d& p) {
  return std::atan2(p.head<2>().norm(), p.z());
}

DistortedPoint distort_point(const Fisheye& k, const Eigen::Vector3d& p) {
  const double r2 = p.head<2>().squaredNorm(), r = std::sqrt(r2), squared = p.squaredNorm();
  if (r < 1e-9 * p.z()) {  // on the axis: θ_d = r / z
    Eigen::Matrix<double, 2, 3> J;
    J << 1, 0, -p.x() / p.z(), 0, 1, -p.y() / p.z();
    return {p.head<2>() / p.z(), J / p.z()};
  }
  const FisheyeRadius radius = fisheye_radius(k, off_axis_angle(p));
  const Eigen::Vector2d u = p.head<2>() / r;
  DistortedPoint d;
  d.xy = radius.value * u;
  const Eigen::RowVector3d J_theta(u.x() * p.z() / squared, u.y() * p.z() / squared, -r / squared);
  d.J_xy_point = u * (radius.slope * J_theta);
  d.J_xy_point.leftCols<2>() += radius.value / r * (Eigen::Matrix2d::Identity() - u * u.transpose());
  return d;
}

bool folds(const Fisheye& k, const Eigen::Vector3d& p) {
  constexpr int kSteps = 24;
  const double theta = off_axis_angle(p);
  for (int i = 1; i <= kSteps; ++i) {
    if (!(fisheye_radius(k, theta * i / kSteps).slope > 0)) return true;
  }
  return false;
}

std::optional<Eigen::Vector3d> direction_at(const Fisheye& k, const Eigen::Vector2d& target) {
  const double radius = target.norm();
  if (radius < 1e-12) return Eigen::Vector3d(target.x(), target.y(), 1.0).normalized();
  double low = 0, high = std::numbers::pi, theta = std::min(radius, 0.9 * high);
  for (int i = 0; i < 60; ++i) {
    const FisheyeRadius at = fisheye_radius(k, theta);
    const double error = radius - at.value;
    // The radius grows up to the fold: where it no longer does, the angle is too large whatever its radius.
    const bool grows = at.slope > 0;
    if (grows && std::abs(error) < 1e-13) break;
    (grows && error > 0 ? low : high) = theta;
    theta += error / at.slope;
    if (!grows || !(theta > low && theta < high)) theta = 0.5 * (low + high);
  }
  if (!(std::abs(fisheye_radius(k, theta).value - radius) < 1e-9) || theta > std::numbers::pi) return std::nullopt;
  const Eigen::Vector2d side = std::sin(theta) / radius * target;
  const Eigen::Vector3d direction(side.x(), side.y(), std::cos(theta));
  if (folds(k, direction)) return std::nullopt;
  return direction;
}

Jacobian jacobian_at(const BrownConrady& k, const Eigen::Vector3d& p) {
  const Eigen::Vector2d xy = p.head<2>() / p.z();
  const double s = xy.squaredNorm();
  const RadialFactor f = radial_factor(k, s);
  Jacobian J(2, 8);
  const double powers[] = {s, s * s, s * s * s};
  const int numerator[] = {0, 1, 4};
  for (int i = 0; i < 3; ++i) {
    J.col(numerator[i]) = powers[i] / f.d * xy;
    J.col(5 + i) = -powers[i] * f.n / (f.d * f.d) * xy;
  }
  const double cross = 2.0 * xy.x() * xy.y();
  J.col(2) << cross, s + 2.0 * xy.y() * xy.y();
  J.col(3) << s + 2.0 * xy.x() * xy.x(), cross;
  return J;
}

Jacobian jacobian_at(const Fisheye&, const Eigen::Vector3d& p) {
  Jacobian J = Jacobian::Zero(2, 4);
  const double r = p.head<2>().norm();
  if (r < 1e-9 * p.z()) return J;
  const double theta = off_axis_angle(p), s = theta * theta;
  double power = theta;
  for (int i = 0; i < 4; ++i) J.col(i) = (power *= s) / r * p.head<2>();
  return J;
}

constexpr std::array<std::string_view, 8> kBrownConradyNames{"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
constexpr std::array<std::string_view, 4> kFisheyeNames{"k1", "k2", "k3", "k4"};

}  // namespace

DistortionCoefficients coefficients(const Distortion& distortion) {
  DistortionCoefficients values;
  if (const auto* k = std::get_if<BrownConrady>(&distortion)) {
    values.resize(8);
    values << k->k1, k->k2, k->p1, k->p2, k->k3, k->k4, k->k5, k->k6;
  } else {
    const auto& fisheye = std::get<Fisheye>(distortion);
    values.resize(4);
    values << fisheye.k1, fisheye.k2, fisheye.k3, fisheye.k4;
  }
  return values;
}

std::span<const std::string_view> coefficient_names(const Distortion& distortion) {
  if (std::holds_alternative<Fisheye>(distortion)) return kFisheyeNames;
  return kBrownConradyNames;
}

Distortion with_coefficients(const Distortion& model, std::span<const double> values) {
  if (values.size() > coefficient_names(model).size())
    throw std::invalid_argument("more coefficients than the model has");
  const auto at = [&](std::size_t i) { return i < values.size() ? values[i] : 0.0; };
  if (std::holds_alternative<Fisheye>(model)) return Fisheye{at(0), at(1), at(2), at(3)};
  return BrownConrady{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)};
}

bool is_pinhole(const Distortion& distortion) {
  const auto* k = std::get_if<BrownConrady>(&distortion);
  return k && *k == BrownConrady{};
}

DistortedPoint distort(const Distortion& distortion, const Eigen::Vector3d& p_camera) {
  return std::visit([&](const auto& k) { return distort_point(k, p_camera); }, distortion);
}

Jacobian coefficient_jacobian(const Distortion& distortion, const Eigen::Vector3d& p_camera) {
  return std::visit([&](const auto& k) { return jacobian_at(k, p_camera); }, distortion);
}

bool folds_back(const Distortion& distortion, const Eigen::Vector3d& p_camera) {
  return std::visit([&](const auto& k) { return folds(k, p_camera); }, distortion);
}

std::optional<Eigen::Vector3d> undistorted_direction(const Distortion& distortion, const Eigen::Vector2d& xy) {
  return std::visit([&](const auto& k) { return direction_at(k, xy); }, distortion);
}

}  // namespace alidade
