// SPDX-License-Identifier: Apache-2.0
#include "uav/window/window_scans.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

namespace alidade {
namespace {

// The period in which a bearing lies, or its very time.
std::int64_t period_of(Timestamp time, Timestamp first, double period_s) {
  const auto since = time - first;
  if (period_s <= 0.0) return since.count();
  return static_cast<std::int64_t>(std::floor(to_seconds(since) / period_s + 1e-9));
}

void add_scans(std::span<const Bearing> bearings, BearingWindow& window) {
  const auto first = std::min_element(bearings.begin(), bearings.end(),
                                      [](const Bearing& a, const Bearing& b) { return a.time < b.time; });
  std::map<std::pair<std::int64_t, int>, WindowScan> by_period;
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    const std::int64_t period = period_of(bearings[i].time, first->time, window.options.period_s);
    WindowScan& scan = by_period[{period, bearings[i].receiver}];
    scan.receiver = bearings[i].receiver;
    scan.t_s += window.rows[i].t_s;
    scan.bearings.push_back(i);
  }
  for (auto& [key, scan] : by_period) {
    scan.t_s /= static_cast<double>(scan.bearings.size());
    window.scans.push_back(std::move(scan));
  }
  std::stable_sort(window.scans.begin(), window.scans.end(),
                   [](const WindowScan& a, const WindowScan& b) { return a.t_s < b.t_s; });
}

void sort_directions(const BearingWindow& window, WindowScan& scan) {
  std::vector<Eigen::Vector3d> directions;
  const Eigen::Vector3d& origin = window.rows[scan.bearings.front()].origin;
  for (const std::size_t i : scan.bearings) {
    const BearingRows& row = window.rows[i];
    directions.push_back(row.direction);
    scan.half_time_s = std::max(scan.half_time_s, std::abs(row.t_s - scan.t_s));
    scan.origin_spread_m = std::max(scan.origin_spread_m, (row.origin - origin).norm());
    scan.greatest_sigma_rad = std::max(scan.greatest_sigma_rad, window.sigma_rad[i]);
  }
  scan.grid = DirectionGrid(directions);
}

}  // namespace

BearingWindow prepare_window(std::span<const Bearing> bearings, const WindowOptions& options) {
  BearingWindow window;
  window.options = options;
  window.frame = frame_of(bearings);
  window.rows = rows_of(bearings, window.frame);
  window.sigma_rad.reserve(bearings.size());
  window.log_gain.reserve(bearings.size());
  for (const Bearing& bearing : bearings) {
    const double area = std::sqrt(bearing.covariance(0, 0) * bearing.covariance(1, 1) -
                                  bearing.covariance(0, 1) * bearing.covariance(1, 0));
    window.sigma_rad.push_back(std::sqrt(0.5 * bearing.covariance.trace()));
    window.log_gain.push_back(
        std::log(options.detection_probability / (options.false_bearings_per_sr * 2.0 * std::numbers::pi * area)));
  }
  add_scans(bearings, window);
  for (WindowScan& scan : window.scans) sort_directions(window, scan);
  window.scan_of.resize(bearings.size());
  for (std::size_t s = 0; s < window.scans.size(); ++s) {
    for (const std::size_t i : window.scans[s].bearings) window.scan_of[i] = s;
  }
  const auto by_time = [](const BearingRows& a, const BearingRows& b) { return a.t_s < b.t_s; };
  const auto [begin, end] = std::minmax_element(window.rows.begin(), window.rows.end(), by_time);
  window.begin_s = begin->t_s;
  window.end_s = end->t_s;
  return window;
}

}  // namespace alidade
