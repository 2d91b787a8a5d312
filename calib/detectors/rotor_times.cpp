// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/rotor_times.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include "core/time.h"

namespace alidade {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kThirdOfTurn = kTurn / 3.0;
// Ticks of 48 MHz in a rotation, channel by channel. Source: libsurvive, Crazyflie firmware.
constexpr double kPeriodTicks[] = {959000, 957000, 953000, 949000, 947000, 943000, 941000, 939000,
                                   937000, 929000, 919000, 911000, 907000, 901000, 893000, 887000};
constexpr double kTicksPerSecond = 48e6;
constexpr double kPeriodTolerance = 5e-6;  // s; neighbouring channels are 40 µs apart
constexpr double kSweepSpread = 1e-3;      // s; within it one sweep passes all markers
constexpr double kLongestPair = 12e-3;     // s; from one sweep of a rotation to the other
constexpr std::size_t kLeastRotations = 200;
constexpr double kLeastSpan = 20.0;       // s; the beat of two stations takes about 10 s
constexpr double kClockError = 0.02;      // clocks off by 1 % have been met
constexpr double kDrift = 2e-4;           // s; over the recording, from one rate that is tried to the next
constexpr double kShare = 0.99;           // of the rotations have to lie within the range of delays
constexpr double kLeastDelays = 1e-3;     // s; a smaller range is not worth a repair
constexpr double kMostDelays = 0.75;      // of a rotation; with a wrong rate delays fill all of it
constexpr double kRangeTolerance = 1e-3;  // s; the same receiver delays all stations alike

// Both sweeps of one rotor's turn.
struct Rotation {
  double stamp_s = 0.0;
  double angles[2] = {0.0, 0.0};      // of the first reading of either sweep
  std::vector<std::size_t> sweep[2];  // readings
};

struct Rotor {
  double period_s = 0.0;  // true
  std::vector<Rotation> rotations;
};

int sweep_of(const LineModel& model) {
  if (const auto* m = std::get_if<Lighthouse2>(&model)) return m->sweep;
  if (const auto* m = std::get_if<Lighthouse2Full>(&model)) return m->sweep;
  return -1;
}

// How far the rotor has turned since its start when the sweep reads `angle`, as a part of a turn.
double turned(int sweep, double angle) {
  return (angle + kThirdOfTurn * (sweep + 1)) / kTurn;
}

double seconds_of(const LineReading& reading) {
  return to_seconds(reading.time.time_since_epoch());
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

using SweepById = std::map<int, std::pair<std::string, int>>;  // station, sweep

SweepById find_sweeps(std::span<const LineDetector> detectors) {
  SweepById sweeps;
  for (const LineDetector& detector : detectors) {
    const int sweep = sweep_of(detector.model);
    if (sweep >= 0) sweeps[detector.id] = {detector.station, sweep};
  }
  return sweeps;
}

std::map<std::string, Rotor> find_rotations(const SweepById& sweeps, std::span<const LineReading> readings) {
  std::map<std::string, Rotor> rotors;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto found = sweeps.find(readings[i].detector);
    if (found == sweeps.end()) continue;
    const auto& [station, sweep] = found->second;
    auto& all = rotors[station].rotations;
    const double t = seconds_of(readings[i]);
    const bool is_new = all.empty() || !all.back().sweep[1].empty() || t > all.back().stamp_s + kSweepSpread;
    if (sweep == 0 && is_new) all.push_back({t, {}, {}});
    if (all.empty() || t > all.back().stamp_s + kLongestPair) continue;
    Rotation& rotation = all.back();
    if (rotation.sweep[sweep].empty()) rotation.angles[sweep] = readings[i].value;
    rotation.sweep[sweep].push_back(i);
  }
  for (auto& [station, rotor] : rotors)
    std::erase_if(rotor.rotations, [](const auto& r) { return r.sweep[1].empty(); });
  return rotors;
}

// From the times between the two sweeps that a marker sees of a rotation; stamps are exact for some marker, and rough
// for others. 0 for none of the channels.
double find_period(const std::vector<Rotation>& rotations, std::span<const LineReading> readings) {
  std::map<int, std::vector<double>> by_marker;
  for (const Rotation& r : rotations) {
    for (const std::size_t i : r.sweep[0]) {
      for (const std::size_t j : r.sweep[1]) {
        if (readings[i].marker != readings[j].marker) continue;
        by_marker[readings[i].marker].push_back((seconds_of(readings[j]) - seconds_of(readings[i])) /
                                                (turned(1, readings[j].value) - turned(0, readings[i].value)));
      }
    }
  }
  double found = 0.0, nearest = kPeriodTolerance;
  for (auto& [marker, periods] : by_marker) {
    const double measured = median(std::move(periods));
    for (const double ticks : kPeriodTicks) {
      const double off = std::abs(measured - ticks / kTicksPerSecond);
      if (off >= nearest) continue;
      nearest = off;
      found = ticks / kTicksPerSecond;
    }
  }
  return found;
}

// The shortest range, modulo the period, that has nearly all stamps, counted from the passing of a sweep.
struct Delays {
  double begin_s = 0.0, length_s = 0.0;
};

Delays find_delays(const Rotor& rotor, double period_s, int sweep = 1) {
  std::vector<double> phases;
  for (const Rotation& r : rotor.rotations) {
    const double phase = std::fmod(r.stamp_s - turned(sweep, r.angles[sweep]) * period_s, period_s);
    phases.push_back(phase < 0 ? phase + period_s : phase);
  }
  std::sort(phases.begin(), phases.end());
  const std::size_t n = phases.size(), within = static_cast<std::size_t>(std::ceil(kShare * static_cast<double>(n)));
  Delays shortest{0.0, period_s};
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t last = i + within - 1;
    const double length = phases[last % n] + (last >= n ? period_s : 0.0) - phases[i];
    if (length < shortest.length_s) shortest = {phases[i], length};
  }
  return shortest;
}

// The rate of the clock with which delays span least.
double find_clock_ratio(const std::map<std::string, Rotor>& rotors, double span_s) {
  double best = 1.0, least = std::numeric_limits<double>::infinity();
  const double step = kDrift / span_s;
  const int count = static_cast<int>(kClockError / step);
  for (int i = -count; i <= count; ++i) {
    const double ratio = 1.0 + i * step;
    double sum = 0;
    for (const auto& [station, rotor] : rotors) {
      const double period = ratio * rotor.period_s;
      sum += find_delays(rotor, period).length_s / period;
    }
    if (sum >= least) continue;
    least = sum;
    best = ratio;
  }
  return best;
}

// The range of delays of all stations; empty where they are none, or not of one kind.
std::optional<double> common_range(const std::map<std::string, Rotor>& rotors, double ratio) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const auto& [station, rotor] : rotors) {
    const double period = ratio * rotor.period_s, length = find_delays(rotor, period).length_s;
    if (find_delays(rotor, period, 0).length_s < kLeastDelays || length > kMostDelays * period) return std::nullopt;
    least = std::min(least, length);
    most = std::max(most, length);
  }
  if (most - least > kRangeTolerance) return std::nullopt;
  return most;
}

// Times of the readings, s; NaN for those of a sweep that has no rotation.
std::vector<double> passing_times(const std::map<std::string, Rotor>& rotors, const SweepById& sweeps,
                                  std::span<const LineReading> readings, double ratio) {
  std::vector<double> times;
  for (const LineReading& reading : readings) {
    times.push_back(sweeps.contains(reading.detector) ? std::numeric_limits<double>::quiet_NaN() : seconds_of(reading));
  }
  std::vector<double> shifts;
  for (const auto& [station, rotor] : rotors) {
    const double period = ratio * rotor.period_s;
    const Delays delays = find_delays(rotor, period);
    const double margin = 0.5 * (period - delays.length_s);  // the few outside belong to the nearer end
    for (const Rotation& r : rotor.rotations) {
      const double phase = r.stamp_s - turned(1, r.angles[1]) * period - delays.begin_s;
      const double start = delays.begin_s + std::floor((phase + margin) / period) * period;
      for (const int sweep : {0, 1}) {
        for (const std::size_t i : r.sweep[sweep]) {
          times[i] = start + turned(sweep, readings[i].value) * period;
          shifts.push_back(seconds_of(readings[i]) - times[i]);
        }
      }
    }
  }
  const double shift = median(std::move(shifts));
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (sweeps.contains(readings[i].detector)) times[i] += shift;
  }
  return times;
}

}  // namespace

std::optional<RotorTimes> time_by_rotors(std::span<const LineDetector> detectors,
                                         std::span<const LineReading> readings) {
  const SweepById sweeps = find_sweeps(detectors);
  auto rotors = find_rotations(sweeps, readings);
  if (rotors.size() < 2) return std::nullopt;
  const double span = seconds_of(readings.back()) - seconds_of(readings.front());
  if (span < kLeastSpan) return std::nullopt;
  for (auto& [station, rotor] : rotors) {
    if (rotor.rotations.size() < kLeastRotations) return std::nullopt;
    rotor.period_s = find_period(rotor.rotations, readings);
    if (rotor.period_s == 0.0) return std::nullopt;
  }
  RotorTimes result;
  result.clock_ratio = find_clock_ratio(rotors, span);
  const auto range = common_range(rotors, result.clock_ratio);
  if (!range) return std::nullopt;
  result.delay_range_s = *range;
  const auto times = passing_times(rotors, sweeps, readings, result.clock_ratio);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (std::isnan(times[i])) continue;
    result.readings.push_back(readings[i]);
    result.readings.back().time = Timestamp(from_seconds(times[i]));
  }
  std::stable_sort(result.readings.begin(), result.readings.end(),
                   [](const LineReading& a, const LineReading& b) { return a.time < b.time; });
  return result;
}

}  // namespace alidade
