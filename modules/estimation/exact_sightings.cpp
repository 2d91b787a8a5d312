// SPDX-License-Identifier: Apache-2.0
#include "estimation/exact_sightings.h"

#include <algorithm>
#include <array>
#include <limits>

namespace alidade {
namespace {

constexpr int kAbreast = 4;                                          // sightings in one go: two registers of two
constexpr double kNearest_m = 1e-9;                                  // as project()
constexpr double kUnseen = std::numeric_limits<double>::infinity();  // χ²
using Lanes = Eigen::Array<double, kAbreast, 1>;
using Row = std::array<Lanes, 6>;  // of ∂pixel/∂xi, without the entry that is zero, and the residual

// The rows are, with x and y as normalised coordinates and (e_x, e_y) as the residual, in focal lengths:
//   (-1/z,    0, x/z,      x y, -(1 + x²),  y | e_x)
//   (   0, -1/z, y/z, (1 + y²),      -x y, -x | e_y)
Row row_of_x(const Lanes& x, const Lanes& y, const Lanes& per_z, const Lanes& residual) {
  return {-per_z, x * per_z, x * y, -(1.0 + x * x), y, residual};
}

Row row_of_y(const Lanes& x, const Lanes& y, const Lanes& per_z, const Lanes& residual) {
  return {-per_z, y * per_z, 1.0 + y * y, -x * y, -x, residual};
}

// The sum of weighted squares of rows. Only the first entry keeps the two kinds apart.
struct SumOfSquares {
  Row first_of_x = zero(), first_of_y = zero();
  std::array<Row, 6> others{zero(), zero(), zero(), zero(), zero(), zero()};  // by column, from the diagonal down

  static Row zero() {
    Row row;
    row.fill(Lanes::Zero());
    return row;
  }

  void add(const Row& row_x, const Row& row_y, const Lanes& weight_x, const Lanes& weight_y) {
    const Lanes x = weight_x * row_x[0], y = weight_y * row_y[0];
    for (std::size_t i = 0; i < 6; ++i) {
      first_of_x[i] += x * row_x[i];
      first_of_y[i] += y * row_y[i];
    }
    add_others<1>(row_x, row_y, weight_x, weight_y);
  }

  // Column j and those after it; a template, so that the compiler unrolls the triangle.
  template <std::size_t j>
  void add_others(const Row& row_x, const Row& row_y, const Lanes& weight_x, const Lanes& weight_y) {
    const Lanes x = weight_x * row_x[j], y = weight_y * row_y[j];
    for (std::size_t i = j; i < 6; ++i) others[j][i] += x * row_x[i] + y * row_y[i];
    if constexpr (j < 5) add_others<j + 1>(row_x, row_y, weight_x, weight_y);
  }

  // With both kinds' first entries in columns of their own.
  Eigen::Matrix<double, 7, 7> lower_triangle() const {
    Eigen::Matrix<double, 7, 7> sum = Eigen::Matrix<double, 7, 7>::Zero();
    for (int i = 1; i < 6; ++i) {
      sum(i + 1, 0) = first_of_x[i].sum();
      sum(i + 1, 1) = first_of_y[i].sum();
      for (int j = 1; j <= i; ++j) sum(i + 1, j + 1) = others[j][i].sum();
    }
    sum(0, 0) = first_of_x[0].sum();
    sum(1, 1) = first_of_y[0].sum();
    return sum;
  }
};

}  // namespace

ExactSightings::ExactSightings(const Camera& camera, std::span<const PointObservation> observations,
                               double variance_factor)
    : count_(static_cast<Eigen::Index>(observations.size())), focal_(camera.fx, camera.fy) {
  const Eigen::Index size = (count_ + kAbreast - 1) / kAbreast * kAbreast;
  for (Array* array : {&x_world_, &y_world_, &z_world_, &x_pixel_, &y_pixel_, &per_variance_, &x_, &y_, &per_z_,
                       &x_residual_, &y_residual_, &chi2_}) {
    array->resize(size);
  }
  for (Eigen::Index i = 0; i < size; ++i) {
    const PointObservation& o = observations[static_cast<std::size_t>(std::min(i, count_ - 1))];
    x_world_(i) = o.p_world.x();
    y_world_(i) = o.p_world.y();
    z_world_(i) = o.p_world.z();
    x_pixel_(i) = (o.pixel.x() - camera.cx) / camera.fx;
    y_pixel_(i) = (o.pixel.y() - camera.cy) / camera.fy;
    per_variance_(i) = 1.0 / (variance_factor * o.sigma_px * o.sigma_px);
  }
}

void ExactSightings::linearise(const Eigen::Isometry3d& T_camera_world) {
  const Eigen::Matrix4d& T = T_camera_world.matrix();
  const double fx2 = focal_.x() * focal_.x(), fy2 = focal_.y() * focal_.y();
  for (Eigen::Index k = 0; k < chi2_.size(); k += kAbreast) {
    const auto at = [k](auto& array) { return array.template segment<kAbreast>(k); };
    const Lanes x_world = at(x_world_), y_world = at(y_world_), z_world = at(z_world_);
    const auto row = [&](int i) { return T(i, 0) * x_world + T(i, 1) * y_world + T(i, 2) * z_world + T(i, 3); };
    const Lanes per_z = row(2).inverse();
    const Lanes x = row(0) * per_z, y = row(1) * per_z;
    const Lanes x_residual = at(x_pixel_) - x, y_residual = at(y_pixel_) - y;
    at(per_z_) = per_z;
    at(x_) = x;
    at(y_) = y;
    at(x_residual_) = x_residual;
    at(y_residual_) = y_residual;
    at(chi2_) = (fx2 * x_residual.square() + fy2 * y_residual.square()) * at(per_variance_);
  }
  for (Eigen::Index i = 0; i < chi2_.size(); ++i) {
    if (per_z_(i) > 0 && per_z_(i) < 1.0 / kNearest_m) continue;
    x_(i) = y_(i) = per_z_(i) = x_residual_(i) = y_residual_(i) = 0.0;
    chi2_(i) = kUnseen;
  }
  chi2_.tail(chi2_.size() - count_).setConstant(kUnseen);
}

Eigen::Matrix<double, 2, 7> ExactSightings::in_px(Eigen::Index i) const {
  const double x = x_(i), y = y_(i), per_z = per_z_(i);
  Eigen::Matrix<double, 2, 7> rows;
  rows << -per_z, 0, x * per_z, x * y, -(1 + x * x), y, x_residual_(i),  //
      0, -per_z, y * per_z, 1 + y * y, -x * y, -x, y_residual_(i);
  return focal_.asDiagonal() * rows;
}

Eigen::Matrix2d ExactSightings::noise(Eigen::Index i) const {
  return Eigen::Matrix2d::Identity() / per_variance_(i);
}

NormalEquations ExactSightings::weighted_sum(const Array& weight) const {
  const double fx2 = focal_.x() * focal_.x(), fy2 = focal_.y() * focal_.y();
  SumOfSquares sum;
  for (Eigen::Index k = 0; k < chi2_.size(); k += kAbreast) {
    const auto at = [k](const Array& array) { return array.segment<kAbreast>(k); };
    const Lanes x = at(x_), y = at(y_), per_z = at(per_z_), w = at(weight) * at(per_variance_);
    sum.add(row_of_x(x, y, per_z, at(x_residual_)), row_of_y(x, y, per_z, at(y_residual_)), fx2 * w, fy2 * w);
  }
  return normal_equations(sum.lower_triangle());
}

}  // namespace alidade
