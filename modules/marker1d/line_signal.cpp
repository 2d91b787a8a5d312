// SPDX-License-Identifier: Apache-2.0
#include "marker1d/line_signal.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/core/utility.hpp>

namespace alidade {
namespace {

LineSignalOptions checked(LineSignalOptions options) {
  validate(options.peaks);
  if (!(options.rate_hz > 0) || !std::isfinite(options.rate_hz)) {
    throw std::invalid_argument(fmt::format("LineSignalOptions.rate_hz must be > 0, got {}", options.rate_hz));
  }
  return options;
}

Timestamp time_of_row(std::int64_t row, double rate_hz, Timestamp first_time) {
  return first_time + from_seconds(static_cast<double>(row) / rate_hz);
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
    reading.time = time_of_row(found.row, options_.rate_hz, options_.first_time);
    reading.detector = options_.detector;
    reading.marker = found.marker;
    reading.value = found.peak.position_px;
    reading.sigma = found.peak.sigma_px;
    readings.push_back(reading);
  }
  return readings;
}

LineSignals::LineSignals(const std::vector<LineSignalOptions>& detectors) {
  if (detectors.empty()) throw std::invalid_argument("LineSignals: no detectors");
  rate_hz_ = detectors.front().rate_hz;
  first_time_ = detectors.front().first_time;
  delay_rows_ = 0;
  for (const LineSignalOptions& options : detectors) {
    if (options.rate_hz != rate_hz_ || options.first_time != first_time_) {
      throw std::invalid_argument(
          fmt::format("detector {}: its rows are not exposed with the others'", options.detector));
    }
    delay_rows_ = std::max<std::int64_t>(delay_rows_, options.tracker.most_delay_rows);
    signals_.emplace_back(options);
  }
}

std::vector<LineReading> LineSignals::read(std::span<const cv::Mat> rows) {
  int count = 0;
  for (const cv::Mat& image : rows) count = std::max(count, image.rows);
  const bool is_whole =
      std::all_of(rows.begin(), rows.end(), [&](const cv::Mat& image) { return image.empty() || image.rows == count; });
  if (rows.size() != signals_.size() || !is_whole) {
    throw std::invalid_argument("LineSignals: as many rows of each detector are wanted");
  }
  std::vector<std::vector<LineReading>> found(signals_.size());
  cv::parallel_for_(cv::Range(0, static_cast<int>(signals_.size())), [&](const cv::Range& range) {
    for (int d = range.start; d < range.end; ++d) {
      const auto i = static_cast<std::size_t>(d);
      for (int row = 0; row < rows[i].rows; ++row) {
        const auto readings = signals_[i].read_row(rows[i].row(row), next_row_ + row);
        found[i].insert(found[i].end(), readings.begin(), readings.end());
      }
    }
  });
  for (const auto& readings : found) kept_.insert(kept_.end(), readings.begin(), readings.end());
  std::stable_sort(kept_.begin(), kept_.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  next_row_ += count;
  return release(time_of_row(next_row_ - delay_rows_, rate_hz_, first_time_));
}

std::vector<LineReading> LineSignals::finish() {
  return release(Timestamp::max());
}

std::vector<LineReading> LineSignals::release(Timestamp until) {
  const auto end = std::find_if(kept_.begin(), kept_.end(), [&](const auto& reading) { return reading.time >= until; });
  std::vector<LineReading> released(kept_.begin(), end);
  kept_.erase(kept_.begin(), end);
  return released;
}

std::vector<LineSignalCounts> LineSignals::counts() const {
  std::vector<LineSignalCounts> counts;
  for (const LineSignal& signal : signals_) counts.push_back(signal.counts());
  return counts;
}

}  // namespace alidade
