// SPDX-License-Identifier: Apache-2.0
#include "marker1d/line_signal.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

LineSignalOptions checked(LineSignalOptions options) {
  validate(options.peaks);
  if (!(options.rate_hz > 0) || !std::isfinite(options.rate_hz)) {
    throw std::invalid_argument(fmt::format("LineSignalOptions.rate_hz must be > 0, got {}", options.rate_hz));
  }
  return options;
}

}  // namespace

LineSignal::LineSignal(LineSignalOptions options)
    : options_(checked(std::move(options))), tracker_(options_.signs, options_.tracker) {}

std::vector<LineReading> LineSignal::read_row(const cv::Mat& row, std::int64_t index) {
  const auto peaks = find_peaks(row, options_.peaks);
  ++rows_;
  std::vector<LineReading> readings;
  for (const IdentifiedPeak& found : tracker_.advance(index, peaks)) {
    LineReading reading;
    reading.time = options_.first_time + from_seconds(static_cast<double>(found.row) / options_.rate_hz);
    reading.detector = options_.detector;
    reading.marker = found.marker;
    reading.value = found.peak.position_px;
    reading.sigma = found.peak.sigma_px;
    readings.push_back(reading);
  }
  return readings;
}

LineSignalReadings read_rows(const cv::Mat& rows, const LineSignalOptions& options) {
  LineSignal signal(options);
  LineSignalReadings result;
  for (int i = 0; i < rows.rows; ++i) {
    const auto readings = signal.read_row(rows.row(i), i);
    result.readings.insert(result.readings.end(), readings.begin(), readings.end());
  }
  std::stable_sort(result.readings.begin(), result.readings.end(),
                   [](const LineReading& a, const LineReading& b) { return a.time < b.time; });
  result.counts = signal.counts();
  return result;
}

}  // namespace alidade
