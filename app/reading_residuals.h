// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/running_statistics.h"
#include "marker1d/body_residuals.h"

namespace alidade {

/// What the residuals of one detector's readings, or of one marker's, come to.
struct ResidualRow {
  std::string of;    ///< "detector", "marker"
  int id = 0;        ///< the detector's or the marker's
  std::string name;  ///< the station's or the body's
  std::string unit;  ///< "rad", "px": of rms and median_magnitude
  std::int64_t readings = 0, inliers = 0;
  // Of the inliers:
  double rms_sigma = 0.0;         ///< in standard deviations: 1 where the detectors' sigma is right
  double mean_sigma = 0.0;        ///< in standard deviations: 0 where the detector is calibrated
  double rms = 0.0;               ///< in the unit
  double median_magnitude = 0.0;  ///< in the unit
};

/// Residual statistics of a stream of readings by detector and by marker, in memory that does not grow.
class ReadingResiduals {
 public:
  ReadingResiduals(const std::vector<LineDetector>& detectors, const std::vector<RigidBody>& bodies);

  /// The residuals of a batch of readings of one body. Throws std::invalid_argument where there are not as many
  /// residuals and inlier marks as readings.
  void add(std::span<const LineReading> readings, std::span<const std::optional<ReadingResidual>> residuals,
           const std::vector<bool>& is_inlier);

  /// All detectors by id, then the markers by id; a marker that was read in both units has a row for each.
  std::vector<ResidualRow> rows() const;

 private:
  struct Tally {
    std::int64_t readings = 0;
    RunningStatistics inliers;                                 // residuals in the unit
    double whitened_sum = 0.0, whitened_sum_of_squares = 0.0;  // of the inliers, too
  };
  using Key = std::pair<int, bool>;  // id, whether it is pixels

  std::map<int, std::pair<std::string, bool>> detectors_;  // station; whether it reads pixels
  std::map<int, std::string> markers_;                     // body
  std::map<Key, Tally> by_detector_, by_marker_;
};

/// What is conspicuous: detectors and markers most of whose readings are not explained, or whose residuals are far
/// larger than their sigma allows. One sentence each.
std::vector<std::string> doubts_about(const std::vector<ResidualRow>& rows);

}  // namespace alidade
