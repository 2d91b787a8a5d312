// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "camera/measurement.h"
#include "core/time.h"
#include "marker1d/blink_tracker.h"
#include "marker1d/line_peaks.h"

namespace alidade {

struct LineSignalOptions {
  int detector = 0;               ///< LineReading::detector of what is read
  double rate_hz = 250.0;         ///< rows per second
  Timestamp first_time{};         ///< of row 0
  std::vector<MarkerSign> signs;  ///< what the markers are told apart by
  LinePeakOptions peaks;
  BlinkTrackerOptions tracker;
};

/// What became of the spots that were found.
struct LineSignalCounts {
  std::int64_t rows = 0;
  std::int64_t peaks = 0;       ///< spots of light, markers and others
  std::int64_t identified = 0;  ///< those of them that became readings
};

/// From the rows of one detector, as they come, to its readings: the seed paper's Fig. 3. Memory does not grow.
class LineSignal {
 public:
  /// Throws std::invalid_argument for impossible options or signs that cannot be told apart (find_fault).
  explicit LineSignal(LineSignalOptions options);

  /// Row number `index` of the detector (counted from 0 by its clock; increasing, lost ones left out) and what it makes
  /// certain: readings in px of this row and of up to tracker.most_delay_rows earlier ones, in order of time. Throws as
  /// find_peaks.
  std::vector<LineReading> read_row(const cv::Mat& row, std::int64_t index);

  LineSignalCounts counts() const { return {rows_, tracker_.seen(), tracker_.identified()}; }

 private:
  LineSignalOptions options_;
  BlinkTracker tracker_;
  std::int64_t rows_ = 0;
};

/// The signals of detectors whose rows are exposed together, as one stream of readings. Memory does not grow.
class LineSignals {
 public:
  /// Of each detector; their rate_hz and first_time must be the same. Throws std::invalid_argument where they are not,
  /// and as LineSignal does.
  explicit LineSignals(const std::vector<LineSignalOptions>& detectors);

  /// The next rows of each detector, in their order: images of as many rows (else std::invalid_argument), an empty one
  /// where they are lost. Returns, in order of time, the readings that no later row can come before.
  std::vector<LineReading> read(std::span<const cv::Mat> rows);

  /// The readings that were still kept back. Once, and last.
  std::vector<LineReading> finish();

  /// Of each detector.
  std::vector<LineSignalCounts> counts() const;

 private:
  std::vector<LineReading> release(Timestamp until);

  std::vector<LineSignal> signals_;
  double rate_hz_;
  Timestamp first_time_;
  std::int64_t delay_rows_, next_row_ = 0;
  std::vector<LineReading> kept_;  // in order of time
};

}  // namespace alidade
