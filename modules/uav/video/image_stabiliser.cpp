// SPDX-License-Identifier: Apache-2.0
#include "uav/video/image_stabiliser.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "core/median.h"

namespace alidade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Move {
  Vector2d from, by;  // px; `from` is counted from the image's middle
};

Vector2d moved(const Vector2d& from_middle, const Vector3d& sway) {
  return Eigen::Rotation2Dd(sway[2]) * from_middle + sway.head<2>();
}

// The strongest, spread over the image, by an absolute bound: in a picture of clouds alone there are none.
std::vector<Vector2d> find_corners(const cv::Mat& grey, const StabiliserOptions& options) {
  constexpr int kBlock_px = 7;
  cv::Mat smooth, strength;
  cv::GaussianBlur(grey, smooth, {5, 5}, 1.0);
  cv::cornerMinEigenVal(smooth, strength, kBlock_px);
  constexpr double kGreyPerUnit = 127.5;  // OpenCV's scale for 8 bits: the root of what it gives to grey levels per px
  double strongest = 0.0;
  cv::minMaxLoc(strength, nullptr, &strongest);
  const double least = std::pow(options.least_gradient_grey / kGreyPerUnit, 2);
  if (strongest <= least) return {};
  std::vector<cv::Point2f> found;
  cv::goodFeaturesToTrack(smooth, found, options.corners, least / strongest, options.corner_distance_px, cv::noArray(),
                          kBlock_px);
  std::vector<Vector2d> corners;
  for (const cv::Point2f& p : found) corners.emplace_back(p.x, p.y);
  return corners;
}

// Least squares by Cauchy weights, linear in shift and turn, around `start`. Source: Huber, Robust Statistics, 7.8.
Vector3d fit_sway(const std::vector<Move>& moves, double scale_px, Vector3d sway) {
  constexpr int kSteps = 8;
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix3d A = 1e-9 * Eigen::Matrix3d::Identity();
    Vector3d b = Vector3d::Zero();
    for (const Move& move : moves) {
      const Vector2d error = move.from + move.by - moved(move.from, sway);
      const double weight = 1.0 / (1.0 + error.squaredNorm() / (scale_px * scale_px));
      Eigen::Matrix<double, 2, 3> J;
      J << 1.0, 0.0, -move.from.y(), 0.0, 1.0, move.from.x();
      A += weight * J.transpose() * J;
      b += weight * J.transpose() * error;
    }
    sway += A.ldlt().solve(b);
  }
  return sway;
}

int count_agreeing(const std::vector<Move>& moves, const Vector3d& sway, double inlier_px) {
  int count = 0;
  for (const Move& move : moves) count += (move.from + move.by - moved(move.from, sway)).norm() < inlier_px;
  return count;
}

Vector3d median_shift(const std::vector<Move>& moves) {
  std::vector<double> x, y;
  for (const Move& move : moves) {
    x.push_back(move.by.x());
    y.push_back(move.by.y());
  }
  return {median(x), median(y), 0.0};
}

}  // namespace

void validate(const StabiliserOptions& o) {
  const auto require = [](bool is_so, const char* what, double value) {
    if (!is_so) throw std::invalid_argument(fmt::format("{}, got {}", what, value));
  };
  require(o.corners >= 3, "corners must be >= 3", o.corners);
  require(o.corner_distance_px >= 1.0, "corner_distance_px must be >= 1 px", o.corner_distance_px);
  require(o.least_gradient_grey > 0.0, "least_gradient_grey must be > 0", o.least_gradient_grey);
  require(o.least_corners >= 2, "least_corners must be >= 2", o.least_corners);
  require(o.inlier_px > 0.0, "inlier_px must be > 0 px", o.inlier_px);
  require(o.most_shift_px > 0.0, "most_shift_px must be > 0 px", o.most_shift_px);
}

ImageStabiliser::ImageStabiliser(const StabiliserOptions& options) : options_(options) {
  validate(options);
  flow_options_.window_px = 15;
  flow_options_.levels = 1;  // a sway from one frame to the next is within 10 px of the last one
}

std::optional<Eigen::Isometry2d> ImageStabiliser::follow(const cv::Mat& grey) {
  if (!first_) {
    first_ = make_flow_image(grey.clone(), flow_options_);
    corners_ = find_corners(grey, options_);
    middle_ = {0.5 * (grey.cols - 1), 0.5 * (grey.rows - 1)};
    return Eigen::Isometry2d::Identity();
  }
  if (static_cast<int>(corners_.size()) < options_.least_corners) return std::nullopt;
  std::vector<Vector2d> guesses;
  for (const Vector2d& corner : corners_) guesses.push_back(middle_ + moved(corner - middle_, last_));
  const auto seen = follow_points(*first_, make_flow_image(grey, flow_options_), corners_, guesses, flow_options_);
  std::vector<Move> moves;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    if (seen[i]) moves.push_back({corners_[i] - middle_, *seen[i] - corners_[i]});
  }
  if (static_cast<int>(moves.size()) < options_.least_corners) return std::nullopt;
  const Vector3d sway = fit_sway(moves, 0.2 * options_.inlier_px, median_shift(moves));
  if (count_agreeing(moves, sway, options_.inlier_px) < options_.least_corners) return std::nullopt;
  if (sway.head<2>().norm() > options_.most_shift_px) return std::nullopt;
  remember(sway);
  Eigen::Isometry2d T_image_first = Eigen::Isometry2d::Identity();
  T_image_first.linear() = Eigen::Rotation2Dd(sway[2]).toRotationMatrix();
  T_image_first.translation() = middle_ + moved(-middle_, sway);
  return T_image_first;
}

void ImageStabiliser::remember(const Vector3d& sway) {
  const Vector2d mean = sum_.head<2>() / (followed_ + 1.0);
  for (int i = 0; i < 2; ++i) returns_[i] += (last_[i] - mean[i]) * (sway[i] - mean[i]) < 0.0;
  last_ = sway;
  sum_ += sway;
  sum_of_squares_ += sway.head<2>().cwiseAbs2();
  ++followed_;
}

Eigen::Vector2d ImageStabiliser::mean_pixel(const Eigen::Vector2d& first) const {
  const Vector3d mean = sum_ / (followed_ + 1.0);  // the first image's is 0
  return middle_ + moved(first - middle_, mean);
}

Eigen::Matrix2d ImageStabiliser::mean_covariance() const {
  const Vector2d mean = sum_.head<2>() / (followed_ + 1.0);
  const Vector2d variance = sum_of_squares_ / (followed_ + 1.0) - mean.cwiseAbs2();
  return variance.cwiseQuotient(Vector2d::Ones() + returns_).asDiagonal();
}

}  // namespace alidade
