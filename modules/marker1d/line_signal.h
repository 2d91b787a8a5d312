// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

/// A recording of one detector: its readings (px), in order of time.
struct LineSignalReadings {
  std::vector<LineReading> readings;
  LineSignalCounts counts;
};

/// All rows of an image, 8 or 16 bits, one or three channels, as successive exposures. Throws as LineSignal; an empty
/// image has no readings.
LineSignalReadings read_rows(const cv::Mat& rows, const LineSignalOptions& options);

}  // namespace alidade
