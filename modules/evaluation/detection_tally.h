// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace alidade {

/// A true object in an image, and which kind of object it is, for whoever counts by kinds.
struct TrueDot {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  int kind = 0;
};

/// What was detected in an image; a covariance of zero: none is stated.
struct DetectedDot {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< px²
};

/// What became of the objects of one kind.
struct KindTally {
  std::size_t there = 0, found = 0;
  std::size_t measured = 0;  ///< found ones whose place is scored
  double sum_of_squares = 0.0, sum_of_nees = 0.0;

  double probability() const;      ///< share of those there that were found; 0 where there are none
  double rms_px() const;           ///< of each coordinate of the place; 0 likewise
  double nees_per_degree() const;  ///< mean normalised squared error: 1 where covariances are honest; 0 likewise
};

/// Detections in many images against the truth.
class DetectionTally {
 public:
  /// `radius_px`: farther from its object a detection is a false one. Two objects nearer than `alone_px` to each other
  /// count as there and found like others, but their places are not scored.
  DetectionTally(std::size_t kinds, double radius_px, double alone_px);

  /// One image's. Throws std::out_of_range for a kind that is not there.
  void add(std::span<const TrueDot> truth, std::span<const DetectedDot> detections);

  const std::vector<KindTally>& kinds() const { return kinds_; }
  double false_per_image() const;

  /// Of several kinds together.
  KindTally together(std::span<const int> kinds) const;

 private:
  std::vector<KindTally> kinds_;
  double radius_px_, alone_px_;
  std::size_t images_ = 0, false_ones_ = 0;
};

}  // namespace alidade
