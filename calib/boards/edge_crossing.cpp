// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/edge_crossing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <Eigen/LU>
#include <ceres/tiny_solver.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

using Eigen::Vector2d;

// Unknowns: the crossing relative to the start, for each edge its angle and ln blur, contrast and background with their
// slopes.
enum Unknown { kX, kY, kAngle1, kAngle2, kLogBlur1, kLogBlur2, kContrast, kContrastX, kContrastY, kLight };
constexpr int kUnknowns = 12;
constexpr int kLeastPixels = 30;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

struct Sample {
  Vector2d offset;  // from the start, px
  double grey;
};

std::vector<Sample> samples_of(const cv::Mat& grey, const CrossingStart& start) {
  Eigen::Matrix2d steps;
  steps << start.step_x, start.step_y;
  const Eigen::Matrix2d inverse = steps.inverse();
  const Vector2d reach = start.half_width * steps.cwiseAbs().rowwise().sum();
  const auto from = [](double low) { return std::max(0, static_cast<int>(std::ceil(low))); };
  const auto to = [](double high, int size) { return std::min(size - 1, static_cast<int>(std::floor(high))); };
  std::vector<Sample> samples;
  for (int y = from(start.pixel.y() - reach.y()); y <= to(start.pixel.y() + reach.y(), grey.rows); y += start.stride) {
    for (int x = from(start.pixel.x() - reach.x()); x <= to(start.pixel.x() + reach.x(), grey.cols);
         x += start.stride) {
      const Vector2d offset = Vector2d(x, y) - start.pixel;
      const Vector2d steps_away = (inverse * offset).cwiseAbs();
      if (steps_away.maxCoeff() > start.half_width || steps_away.minCoeff() > start.band) continue;
      samples.push_back({offset, static_cast<double>(grey.at<uchar>(y, x))});
    }
  }
  return samples;
}

struct Transition {
  double value = 0;  // -1 on one side of the edge, 1 on the other
  Vector2d by_crossing = Vector2d::Zero();
  double by_angle = 0, by_log_blur = 0;
};

// A pixel's own square blurs by at least this, squared: variance of a box one pixel wide.
constexpr double kPixelVariance = 1.0 / 12;

double blur_of(double log_blur) {
  return std::sqrt(kPixelVariance + std::exp(2 * log_blur));
}

class Edge {
 public:
  Edge(double angle, double log_blur, double bend = 0)
      : bend_(bend),
        along_(std::cos(angle), std::sin(angle)),
        across_(-along_.y(), along_.x()),
        per_blur_(1 / (std::numbers::sqrt2 * blur_of(log_blur))),
        by_log_blur_(std::exp(2 * log_blur) * 2 * per_blur_ * per_blur_) {}

  // At a point `q` away from the crossing.
  Transition at(const Vector2d& q) const {
    const double along = along_.dot(q), across = across_.dot(q);
    const double z = (across - 0.5 * bend_ * along * along) * per_blur_;
    if (std::abs(z) > 4) return {.value = z > 0 ? 1.0 : -1.0};  // 2e-8 from there
    const double slope = 2 * std::numbers::inv_sqrtpi * std::exp(-z * z);
    return {std::erf(z), -slope * per_blur_ * (across_ - bend_ * along * along_),
            -slope * per_blur_ * along * (1 + bend_ * across), -slope * z * by_log_blur_};
  }

 private:
  double bend_;  // 1/px, towards across_
  Vector2d along_, across_;
  double per_blur_, by_log_blur_;
};

// Curvature towards the left of `step` (x right, y down: its normal turned from x to y), 1/px.
double bend_of(const Vector2d& step, const Vector2d& bend) {
  return (step.x() * bend.y() - step.y() * bend.x()) / std::pow(step.norm(), 3);
}

class CrossingProblem {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = kUnknowns };

  CrossingProblem(std::vector<Sample> samples, const CrossingStart& start)
      : samples_(std::move(samples)),
        log_blur_(std::log(start.blur_px)),
        bend1_(bend_of(start.step_x, start.bend_x)),
        bend2_(bend_of(start.step_y, start.bend_y)) {}

  int NumResiduals() const { return pixels() + 2; }

  bool operator()(const double* x, double* residuals, double* jacobian) const {
    const Eigen::Map<const Unknowns> m(x);
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, kUnknowns>> J(jacobian, jacobian ? NumResiduals() : 0, kUnknowns);
    const Edge edge1(x[kAngle1], x[kLogBlur1], bend1_), edge2(x[kAngle2], x[kLogBlur2], bend2_);
    for (int i = 0; i < pixels(); ++i) {
      const Vector2d& p = samples_[i].offset;
      const Transition e1 = edge1.at(p - m.head<2>()), e2 = edge2.at(p - m.head<2>());
      const double pattern = e1.value * e2.value, a = m[kContrast] + m.segment<2>(kContrastX).dot(p);
      residuals[i] = m[kLight] + m.tail<2>().dot(p) + a * pattern - samples_[i].grey;
      if (!jacobian) continue;
      J.row(i) << a * (e1.by_crossing * e2.value + e2.by_crossing * e1.value).transpose(), a * e1.by_angle * e2.value,
          a * e2.by_angle * e1.value, a * e1.by_log_blur * e2.value, a * e2.by_log_blur * e1.value, pattern,
          pattern * p.transpose(), 1, p.transpose();
    }
    // An edge along the pixels' rows may show no blur at all: a factor of e then weighs as much as one grey level.
    residuals[pixels()] = m[kLogBlur1] - log_blur_;
    residuals[pixels() + 1] = m[kLogBlur2] - log_blur_;
    if (jacobian) {
      J.bottomRows<2>().setZero();
      J(pixels(), kLogBlur1) = J(pixels() + 1, kLogBlur2) = 1;
    }
    return true;
  }

 private:
  int pixels() const { return static_cast<int>(samples_.size()); }

  std::vector<Sample> samples_;
  double log_blur_, bend1_, bend2_;
};

// Light and contrast by least squares at the geometry of the start.
Unknowns first_guess(const std::vector<Sample>& samples, const CrossingStart& start) {
  Unknowns x = Unknowns::Zero();
  x[kAngle1] = std::atan2(start.step_x.y(), start.step_x.x());
  x[kAngle2] = std::atan2(start.step_y.y(), start.step_y.x());
  x[kLogBlur1] = x[kLogBlur2] = std::log(start.blur_px);
  double sum = 0, product = 0, square = 0;
  for (const Sample& sample : samples) sum += sample.grey;
  x[kLight] = sum / static_cast<double>(samples.size());
  const Edge edge1(x[kAngle1], x[kLogBlur1]), edge2(x[kAngle2], x[kLogBlur2]);
  for (const Sample& sample : samples) {
    const double pattern = edge1.at(sample.offset).value * edge2.at(sample.offset).value;
    product += pattern * (sample.grey - x[kLight]);
    square += pattern * pattern;
  }
  x[kContrast] = product / square;
  return x;
}

bool is_sound(const Unknowns& x, const CrossingStart& start) {
  Eigen::Matrix2d steps;
  steps << start.step_x, start.step_y;
  const double narrow = start.half_width * std::min(start.step_x.norm(), start.step_y.norm());
  return x.allFinite() && (steps.inverse() * x.head<2>()).lpNorm<Eigen::Infinity>() < start.half_width &&
         blur_of(std::max(x[kLogBlur1], x[kLogBlur2])) < narrow && std::abs(std::sin(x[kAngle1] - x[kAngle2])) > 0.1;
}

}  // namespace

std::optional<EdgeCrossing> fit_edge_crossing(const cv::Mat& grey, const CrossingStart& start) {
  if (grey.type() != CV_8UC1) throw std::invalid_argument("fit_edge_crossing: the image must be grey, of 8 bits");
  std::vector<Sample> samples = samples_of(grey, start);
  if (samples.size() < kLeastPixels) return std::nullopt;
  Unknowns x = first_guess(samples, start);
  const CrossingProblem problem(std::move(samples), start);
  ceres::TinySolver<CrossingProblem> solver;
  solver.options.max_num_iterations = 25;
  solver.options.function_tolerance = 1e-3;  // grey levels squared, all pixels together: far below the noise
  solver.Solve(problem, &x);
  if (!is_sound(x, start)) return std::nullopt;

  Eigen::VectorXd residuals(problem.NumResiduals());
  Eigen::Matrix<double, Eigen::Dynamic, kUnknowns> J(problem.NumResiduals(), kUnknowns);
  problem(x.data(), residuals.data(), J.data());
  const double variance = residuals.squaredNorm() / (problem.NumResiduals() - kUnknowns);
  const Eigen::Matrix<double, kUnknowns, kUnknowns> information = J.transpose() * J;
  const Eigen::Matrix2d covariance = variance * information.inverse().topLeftCorner<2, 2>();
  if (!covariance.allFinite()) return std::nullopt;
  return EdgeCrossing{.pixel = start.pixel + x.head<2>(),
                      .covariance_px2 = covariance,
                      .angle_rad = {x[kAngle1], x[kAngle2]},
                      .blur_px = {blur_of(x[kLogBlur1]), blur_of(x[kLogBlur2])},
                      .contrast = std::abs(x[kContrast]),
                      .noise = std::sqrt(variance)};
}

Eigen::Vector2d crossing_by_gradients(const cv::Mat& grey, const Eigen::Vector2d& pixel, int half_width_px) {
  const int fits = (std::min(grey.cols, grey.rows) - 5) / 2;  // what cornerSubPix insists on
  const int half = std::min(fits, half_width_px);
  if (half < 1 || pixel.minCoeff() < 0 || pixel.x() > grey.cols - 1 || pixel.y() > grey.rows - 1) return pixel;
  std::vector<cv::Point2f> point{{static_cast<float>(pixel.x()), static_cast<float>(pixel.y())}};
  cv::cornerSubPix(grey, point, {half, half}, {-1, -1}, {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 1e-3});
  return {point[0].x, point[0].y};
}

}  // namespace alidade
