// SPDX-License-Identifier: Apache-2.0
#include "capture/clock_offset.h"

#include <algorithm>
#include <vector>

namespace alidade {
namespace {

constexpr double kWindow_s = 30;    // over which quartz clocks run straight to some microseconds
constexpr double kBin_s = 0.25;     // of which only the earliest arrival is kept
constexpr double kRateSpan_s = 4;   // shorter spans say nothing of the rate
constexpr double kSteepest = 1e-3;  // no clock of a camera runs worse
constexpr double kJump_s = 0.5;     // no delay is negative: a stamp so far ahead is another clock

std::chrono::nanoseconds difference(Timestamp device, HostTime host) {
  return host.time_since_epoch() - device.time_since_epoch();
}

}  // namespace

bool ClockOffset::observe(Timestamp device, HostTime host) {
  bool is_new = false;
  if (first_device_) {
    const double seen_s = to_seconds(difference(device, host) - first_difference_);
    const double expected_s = difference_at(to_seconds(device - *first_device_));
    is_new = device <= last_device_ || seen_s < expected_s - kJump_s;
  }
  if (is_new || !first_device_) {
    *this = ClockOffset();
    first_device_ = device;
    first_difference_ = difference(device, host);
  }
  last_device_ = device;
  const Pair pair{to_seconds(device - *first_device_), to_seconds(difference(device, host) - first_difference_)};
  const auto bin = [](const Pair& p) { return static_cast<long>(p.device_s / kBin_s); };
  if (pairs_.empty() || bin(pairs_.back()) != bin(pair)) {
    pairs_.push_back(pair);
  } else if (pair.difference_s < pairs_.back().difference_s) {
    pairs_.back() = pair;
  } else {
    return is_new;
  }
  while (pairs_.front().device_s < pair.device_s - kWindow_s) pairs_.pop_front();
  fit();
  return is_new;
}

// The lower hull's edge above which the mean of the device times lies is the line sought: any other line below all
// points is farther from them on average.
void ClockOffset::fit() {
  std::vector<Pair> hull;
  double mean_s = 0;
  for (const Pair& p : pairs_) {
    mean_s += p.device_s / static_cast<double>(pairs_.size());
    const auto turns_right = [&](const Pair& a, const Pair& b) {
      return (b.device_s - a.device_s) * (p.difference_s - a.difference_s) <=
             (b.difference_s - a.difference_s) * (p.device_s - a.device_s);
    };
    while (hull.size() >= 2 && turns_right(hull[hull.size() - 2], hull.back())) hull.pop_back();
    hull.push_back(p);
  }
  const auto lowest = std::min_element(hull.begin(), hull.end(),
                                       [](const Pair& a, const Pair& b) { return a.difference_s < b.difference_s; });
  intercept_s_ = lowest->difference_s;
  slope_ = 0;
  if (pairs_.back().device_s - pairs_.front().device_s < kRateSpan_s) return;
  const auto right =
      std::find_if(hull.begin() + 1, hull.end() - 1, [&](const Pair& p) { return p.device_s >= mean_s; });
  const Pair a = *(right - 1), b = *right;
  const double slope = (b.difference_s - a.difference_s) / (b.device_s - a.device_s);
  if (std::abs(slope) > kSteepest) return;
  slope_ = slope;
  intercept_s_ = a.difference_s - slope * a.device_s;
}

std::optional<HostTime> ClockOffset::to_host(Timestamp device) const {
  if (!first_device_) return std::nullopt;
  const auto moved = from_seconds(difference_at(to_seconds(device - *first_device_)));
  return HostTime(device.time_since_epoch() + first_difference_ + moved);
}

std::optional<std::chrono::nanoseconds> ClockOffset::offset() const {
  if (!first_device_) return std::nullopt;
  return to_host(last_device_)->time_since_epoch() - last_device_.time_since_epoch();
}

}  // namespace alidade
