// SPDX-License-Identifier: Apache-2.0
#include "uav/paper/paper_accuracy.h"

#include <cmath>
#include <stdexcept>

namespace alidade {
namespace {

constexpr double kLeastSine2 = 1e-12;

double squared_sine(double angle_rad) {
  const double sine2 = std::pow(std::sin(angle_rad), 2);
  if (!(sine2 > kLeastSine2))
    throw std::invalid_argument("the ranges along parallel lines of sight are not determined");
  return sine2;
}

}  // namespace

Eigen::Matrix2d range_covariance(double angle_rad, double sigma_m) {
  const double c = std::cos(angle_rad);
  Eigen::Matrix2d K;
  K << 1.0, c, c, 1.0;
  return sigma_m * sigma_m / squared_sine(angle_rad) * K;
}

double range_sigma(std::span<const double> angles_rad, double sigma_m) {
  double sum = 0.0;
  for (const double angle : angles_rad) sum += std::pow(std::sin(angle), 2);
  if (!(sum > kLeastSine2)) throw std::invalid_argument("the ranges along parallel lines of sight are not determined");
  return sigma_m / std::sqrt(sum);
}

Eigen::Matrix2d range_covariance_of_bearings(double angle_rad, double sigma1_m, double sigma2_m) {
  const double c = std::cos(angle_rad), v1 = sigma1_m * sigma1_m, v2 = sigma2_m * sigma2_m;
  Eigen::Matrix2d K;
  K << c * c * v1 + v2, c * (v1 + v2),  //
      c * (v1 + v2), v1 + c * c * v2;
  return K / squared_sine(angle_rad);
}

}  // namespace alidade
