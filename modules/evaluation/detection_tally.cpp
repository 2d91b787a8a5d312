// SPDX-License-Identifier: Apache-2.0
#include "evaluation/detection_tally.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "evaluation/detection_match.h"

namespace alidade {
namespace {

template <typename Dot>
std::vector<Eigen::Vector2d> pixels_of(std::span<const Dot> dots) {
  std::vector<Eigen::Vector2d> pixels;
  for (const Dot& dot : dots) pixels.push_back(dot.pixel);
  return pixels;
}

bool is_alone(std::span<const TrueDot> truth, std::size_t index, double alone_px) {
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i != index && (truth[i].pixel - truth[index].pixel).norm() < alone_px) return false;
  }
  return true;
}

double ratio(double sum, std::size_t count) {
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace

double KindTally::probability() const {
  return ratio(static_cast<double>(found), there);
}

double KindTally::rms_px() const {
  return std::sqrt(ratio(sum_of_squares, 2 * measured));
}

double KindTally::nees_per_degree() const {
  return ratio(sum_of_nees, 2 * measured);
}

DetectionTally::DetectionTally(std::size_t kinds, double radius_px, double alone_px)
    : kinds_(kinds), radius_px_(radius_px), alone_px_(alone_px) {}

void DetectionTally::add(std::span<const TrueDot> truth, std::span<const DetectedDot> detections) {
  const auto match = match_detections(pixels_of(truth), pixels_of(detections), radius_px_);
  std::size_t found = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    KindTally& tally = kinds_.at(static_cast<std::size_t>(truth[i].kind));
    ++tally.there;
    if (!match[i]) continue;
    ++tally.found;
    ++found;
    if (!is_alone(truth, i, alone_px_)) continue;
    const DetectedDot& detection = detections[*match[i]];
    const Eigen::Vector2d error = detection.pixel - truth[i].pixel;
    ++tally.measured;
    tally.sum_of_squares += error.squaredNorm();
    if (!detection.covariance.isZero(0.0)) tally.sum_of_nees += error.dot(detection.covariance.inverse() * error);
  }
  ++images_;
  false_ones_ += detections.size() - found;
}

double DetectionTally::false_per_image() const {
  return ratio(static_cast<double>(false_ones_), images_);
}

KindTally DetectionTally::together(std::span<const int> kinds) const {
  KindTally sum;
  for (const int kind : kinds) {
    const KindTally& tally = kinds_.at(static_cast<std::size_t>(kind));
    sum.there += tally.there;
    sum.found += tally.found;
    sum.measured += tally.measured;
    sum.sum_of_squares += tally.sum_of_squares;
    sum.sum_of_nees += tally.sum_of_nees;
  }
  return sum;
}

}  // namespace alidade
