// SPDX-License-Identifier: Apache-2.0
#include "uav/video/dot_fit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "core/median.h"

namespace alidade {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;  // x, y, height, sigma, level, slope x, slope y
using Matrix7d = Eigen::Matrix<double, 7, 7>;

struct Normal {
  Matrix7d A = Matrix7d::Zero();
  Vector7d b = Vector7d::Zero();
  double error2 = 0.0;
};

// Of the squares of image less model over `area`; places are counted from the peak.
Normal normal_at(const cv::Mat& residual, const cv::Rect& area, const cv::Point& peak, const Vector7d& m) {
  Normal normal;
  for (int y = area.y; y < area.br().y; ++y) {
    const float* row = residual.ptr<float>(y);
    for (int x = area.x; x < area.br().x; ++x) {
      const double u = x - peak.x - m[0], v = y - peak.y - m[1], s2 = m[3] * m[3];
      const double bell = std::exp(-0.5 * (u * u + v * v) / s2), dot = m[2] * bell;
      Vector7d J;
      J << dot * u / s2, dot * v / s2, bell, dot * (u * u + v * v) / (s2 * m[3]), 1.0, x - peak.x, y - peak.y;
      const double error = row[x] - (dot + m[4] + m[5] * (x - peak.x) + m[6] * (y - peak.y));
      normal.A.selfadjointView<Eigen::Lower>().rankUpdate(J);
      normal.b += error * J;
      normal.error2 += error * error;
    }
  }
  normal.A = Matrix7d(normal.A.selfadjointView<Eigen::Lower>());
  return normal;
}

cv::Rect square(const cv::Point& middle, int reach, const cv::Size& size) {
  return cv::Rect(middle.x - reach, middle.y - reach, 2 * reach + 1, 2 * reach + 1) & cv::Rect({}, size);
}

// By the median of the magnitudes on the ring about the fitted square, from the ring's own median, once the fitted
// slope is taken off.
double ring_noise(const cv::Mat& residual, const cv::Rect& inner, const cv::Point& peak, const Vector7d& m) {
  constexpr int kRing_px = 5;
  const cv::Rect outer = square(peak, inner.width / 2 + kRing_px, residual.size());
  std::vector<double> values;
  for (int y = outer.y; y < outer.br().y; ++y) {
    for (int x = outer.x; x < outer.br().x; ++x) {
      if (inner.contains({x, y})) continue;
      values.push_back(residual.at<float>(y, x) - m[5] * (x - peak.x) - m[6] * (y - peak.y));
    }
  }
  if (values.empty()) return 0.0;
  const double level = median(values);
  for (double& value : values) value = std::abs(value - level);
  return 1.4826 * median(std::move(values));
}

// The least squares by damped Gauss-Newton steps, and how well they fit.
std::pair<Vector7d, Normal> settle(const cv::Mat& residual, const cv::Rect& area, const DotPeak& peak,
                                   const DotFitOptions& options) {
  constexpr int kMostSteps = 12;
  constexpr double kSettled_px = 1e-3;
  Vector7d m;
  m << 0.0, 0.0, residual.at<float>(peak.pixel), peak.sigma_px, 0.0, 0.0, 0.0;
  Normal normal = normal_at(residual, area, peak.pixel, m);
  double damping = 1e-3;
  for (int step = 0; step < kMostSteps; ++step) {
    Matrix7d A = normal.A;
    A.diagonal() *= 1.0 + damping;
    const Vector7d change = A.ldlt().solve(normal.b);
    Vector7d moved = m + change;
    moved[3] = std::clamp(moved[3], 0.5 * options.least_sigma_px, 2.0 * options.greatest_sigma_px);
    const Normal next = normal_at(residual, area, peak.pixel, moved);
    if (!(next.error2 <= normal.error2)) {
      damping *= 10.0;
      continue;
    }
    damping *= 0.1;
    m = moved;
    normal = next;
    if (change.head<2>().norm() < kSettled_px) break;
  }
  return {m, normal};
}

}  // namespace

void validate(const DotFitOptions& o) {
  const auto require = [](bool is_so, const char* what, double value) {
    if (!is_so) throw std::invalid_argument(fmt::format("{}, got {}", what, value));
  };
  require(o.least_sigma_px > 0.0, "least_sigma_px must be > 0 px", o.least_sigma_px);
  require(o.greatest_sigma_px > o.least_sigma_px, "greatest_sigma_px must be > least_sigma_px", o.greatest_sigma_px);
  require(o.most_move_px > 0.0, "most_move_px must be > 0 px", o.most_move_px);
  require(o.least_height >= 0.0, "least_height must be >= 0", o.least_height);
  require(o.most_misfit > 0.0, "most_misfit must be > 0", o.most_misfit);
}

std::optional<FittedDot> fit_dot(const cv::Mat& residual, const DotPeak& peak, const DotFitOptions& options) {
  const int reach = static_cast<int>(std::ceil(3.0 * peak.sigma_px)) + 2;
  const cv::Rect area = square(peak.pixel, reach, residual.size());
  const auto [m, normal] = settle(residual, area, peak, options);
  const double noise = ring_noise(residual, area, peak.pixel, m);
  const double misfit2 = normal.error2 / std::max(1, area.area() - static_cast<int>(m.size()));
  const double unexplained = std::sqrt(std::max(0.0, misfit2 - noise * noise));
  const bool is_dot = noise > 0.0 && m.head<2>().norm() <= options.most_move_px && m[3] >= options.least_sigma_px &&
                      m[3] <= options.greatest_sigma_px && m[2] * peak.response > 0.0 &&
                      std::abs(m[2]) >= options.least_height * noise &&
                      unexplained <= options.most_misfit * std::abs(m[2]);
  if (!is_dot) return std::nullopt;
  const Matrix7d covariance = std::max(noise * noise, misfit2) * normal.A.ldlt().solve(Matrix7d::Identity());
  return FittedDot{Eigen::Vector2d(peak.pixel.x, peak.pixel.y) + m.head<2>(), covariance.topLeftCorner<2, 2>(), m[2],
                   m[3], noise};
}

double disc_diameter_px(double sigma_px, double blur_px) {
  constexpr double kPixel2 = 1.0 / 12.0;  // variance of a point's place within its pixel
  // A disc's variance is d²/16; the Gaussian that fits it best by least squares has up to d²/10 (e^q = 1 + 2q, q =
  // d²/8s²).
  constexpr double kDisc = 11.0;
  return std::sqrt(kDisc * std::max(0.0, sigma_px * sigma_px - kPixel2 - blur_px * blur_px));
}

}  // namespace alidade
