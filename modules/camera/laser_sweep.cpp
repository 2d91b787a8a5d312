// SPDX-License-Identifier: Apache-2.0
#include "camera/laser_sweep.h"

#include <cmath>
#include <numbers>

namespace alidade {
namespace {

using Eigen::RowVector3d;
using Eigen::Vector3d;

constexpr double kPlaneTilt = std::numbers::pi / 6.0;
constexpr double kLeastDistance = 1e-9;  // m; nearer to the rotor's axis there is no azimuth
constexpr double kLargestSine = 0.9999;  // beyond it the sweep passes the point almost along itself, or not at all

// A scalar of the point, with its gradient.
struct Scalar {
  double value = 0.0;
  RowVector3d gradient = RowVector3d::Zero();
};

Scalar arcsine(const Scalar& s) {
  return {std::asin(s.value), s.gradient / std::sqrt(1.0 - s.value * s.value)};
}

// atan2(y, x) of two coordinates of the point.
Scalar azimuth(const Vector3d& p, int y, int x) {
  const double r2 = p[x] * p[x] + p[y] * p[y];
  Scalar a{std::atan2(p[y], p[x]), RowVector3d::Zero()};
  a.gradient[x] = -p[y] / r2;
  a.gradient[y] = p[x] / r2;
  return a;
}

// The tangent of the elevation over the plane in which azimuths are taken, times `factor`.
Scalar elevation_tangent(const Vector3d& p, int up, double factor) {
  Vector3d flat = p;
  flat[up] = 0.0;
  const double r = flat.norm();
  Scalar t{factor * p[up] / r, -factor * p[up] / (r * r * r) * flat.transpose()};
  t.gradient[up] = factor / r;
  return t;
}

// Sweep 1 turns about y: it sees the point (x, z, −y) as sweep 0 does.
Vector3d turned(const Vector3d& p, int sweep) {
  return sweep == 0 ? p : Vector3d(p.x(), p.z(), -p.y());
}

RowVector3d turned_back(const RowVector3d& gradient, int sweep) {
  return sweep == 0 ? gradient : RowVector3d(gradient.x(), -gradient.z(), gradient.y());
}

// The polynomial m(u) of libsurvive's second-generation model, highest power first, and its first two derivatives.
struct Ogee {
  double m = 0.0, slope = 0.0, bend = 0.0;
};

Ogee ogee(double u) {
  constexpr double kCoefficients[] = {-8.0108022e-06, 0.0028679863, 5.3685255e-06, 0.0076069798, 0.0, 0.0};
  Ogee o{kCoefficients[0], 0.0, 0.0};
  for (int i = 1; i < 6; ++i) {
    o.bend = o.bend * u + 2.0 * o.slope;
    o.slope = o.slope * u + o.m;
    o.m = o.m * u + kCoefficients[i];
  }
  return o;
}

// Y / (|p| cos y_d), the sine of u, with respect to (X, Y, Z).
Scalar elevation_sine(const Vector3d& p, double cosine) {
  const double length = p.norm();
  Scalar s{p.y() / (length * cosine), -p.y() / (length * length * length * cosine) * p.transpose()};
  s.gradient.y() += 1.0 / (length * cosine);
  return s;
}

// k + m s / (cos y_d − m' s sin y_d), the sine of o; s is the ogee's amplitude at this azimuth.
Scalar offset_sine(const Scalar& k, const Scalar& s, const Scalar& u, double y_d) {
  const Ogee o = ogee(u.value);
  const double denominator = std::cos(y_d) - o.slope * s.value * std::sin(y_d);
  const double quotient = o.m * s.value / denominator;
  const RowVector3d numerator_gradient = o.slope * s.value * u.gradient + o.m * s.gradient;
  const RowVector3d denominator_gradient = -std::sin(y_d) * (o.bend * s.value * u.gradient + o.slope * s.gradient);
  return {k.value + quotient, k.gradient + (numerator_gradient - quotient * denominator_gradient) / denominator};
}

}  // namespace

std::optional<LineProjection> project_sweep(const Lighthouse1& model, const Vector3d& p_station) {
  if (!(p_station.x() > kLeastDistance)) return std::nullopt;
  const SweepTerms& c = model.terms;
  const Vector3d p = turned(p_station, model.sweep);
  const Scalar ax = azimuth(p, 1, 0), ay = azimuth(p, 2, 0), tangent = elevation_tangent(p, 2, std::tan(c.tilt));
  if (std::abs(tangent.value) > kLargestSine) return std::nullopt;
  const Scalar tilt = arcsine(tangent);
  LineProjection reading;
  reading.value =
      ax.value - (tilt.value + c.phase - c.gibmag * std::sin(ax.value + c.gibphase) + c.curve * ay.value * ay.value);
  const RowVector3d gradient = (1.0 + c.gibmag * std::cos(ax.value + c.gibphase)) * ax.gradient - tilt.gradient -
                               2.0 * c.curve * ay.value * ay.gradient;
  reading.J_value_point = turned_back(gradient, model.sweep);
  return reading;
}

std::optional<LineProjection> project_sweep(const Lighthouse2& model, const Vector3d& p) {
  if (!(p.x() > kLeastDistance)) return std::nullopt;
  const SweepTerms& c = model.terms;
  const double tilt = (model.sweep == 0 ? -kPlaneTilt : kPlaneTilt) - c.tilt;
  const Scalar ax = azimuth(p, 1, 0), tangent = elevation_tangent(p, 2, std::tan(tilt));
  if (std::abs(tangent.value) > kLargestSine) return std::nullopt;
  const Scalar offset = arcsine(tangent);
  LineProjection reading;
  reading.value = ax.value + offset.value - c.phase + c.gibmag * std::cos(ax.value + c.gibphase);
  reading.J_value_point = (1.0 - c.gibmag * std::sin(ax.value + c.gibphase)) * ax.gradient + offset.gradient;
  return reading;
}

std::optional<LineProjection> project_sweep(const Lighthouse2Full& model, const Vector3d& p_station) {
  const Vector3d p(p_station.x(), p_station.y(), -p_station.z());
  if (!(p.z() > kLeastDistance)) return std::nullopt;
  const SweepTerms& c = model.terms;
  const double y_d = c.tilt + (model.sweep == 0 ? kPlaneTilt : -kPlaneTilt);
  const Scalar B = azimuth(p, 2, 0), k = elevation_tangent(p, 1, std::tan(y_d));
  const Scalar sine = elevation_sine(p, std::cos(y_d));
  if (std::abs(k.value) > kLargestSine || std::abs(sine.value) > kLargestSine) return std::nullopt;

  const Scalar asin_k = arcsine(k);
  const double swing = B.value - asin_k.value + c.ogeephase;
  const Scalar s{c.ogeemag * std::sin(swing) + c.curve, c.ogeemag * std::cos(swing) * (B.gradient - asin_k.gradient)};
  const Scalar offset = offset_sine(k, s, arcsine(sine), y_d);
  if (std::abs(offset.value) > kLargestSine) return std::nullopt;

  const Scalar o = arcsine(offset);
  const double angle = B.value - o.value;
  LineProjection reading;
  reading.value = angle + c.gibmag * std::sin(angle + c.gibphase) - c.phase - std::numbers::pi / 2.0;
  reading.J_value_point = (1.0 + c.gibmag * std::cos(angle + c.gibphase)) * (B.gradient - o.gradient);
  reading.J_value_point.z() *= -1.0;  // Z = −z
  return reading;
}

}  // namespace alidade
