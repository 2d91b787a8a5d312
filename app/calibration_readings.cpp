// SPDX-License-Identifier: Apache-2.0
#include "app/calibration_readings.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/reading_source.h"
#include "calib/detectors/rotor_times.h"
#include "core/nearest_name.h"

namespace alidade {
namespace {

double seconds_of(Timestamp time) {
  return to_seconds(time.time_since_epoch());
}

std::string span_of(const std::vector<LineReading>& readings) {
  return fmt::format("{:.3f} to {:.3f} s", seconds_of(readings.front().time), seconds_of(readings.back().time));
}

double start_of(const TimeInterval& interval) {
  return interval.start_s.value_or(-std::numeric_limits<double>::infinity());
}

double end_of(const TimeInterval& interval) {
  return interval.end_s.value_or(std::numeric_limits<double>::infinity());
}

}  // namespace

bool overlap(const TimeInterval& a, const TimeInterval& b) {
  return start_of(a) < end_of(b) && start_of(b) < end_of(a);
}

std::vector<LineReading> read_all(const std::string& path, const DetectorRig& rig, const std::vector<RigidBody>& bodies,
                                  const RunContext& context) {
  constexpr std::size_t kReadingsPerReport = 4096;
  const auto source = open_readings(path, rig.detectors, bodies, context.stop);
  std::vector<LineReading> readings;
  while (const auto reading = source->next()) {
    readings.push_back(*reading);
    if (readings.size() % kReadingsPerReport == 0) context.progress(progress_of(*source, "reading"));
  }
  if (readings.empty() && !context.stop.stop_requested()) {
    throw InputError(name_of_source(path), 0, "holds no reading", "record the moving body");
  }
  return readings;
}

std::vector<LineReading> repair_times(std::vector<LineReading> readings, const DetectorRig& rig,
                                      const std::string& source, std::vector<std::string>& warnings) {
  auto timed = time_by_rotors(rig.detectors, readings);
  if (!timed) return readings;
  warnings.push_back(
      fmt::format("{}: some readings were stamped up to {:.1f} ms later than others; each has the time at which its "
                  "sweep passed, by "
                  "the rotors' known periods, of whose seconds the recording's clock counts {:.5f}",
                  source, 1e3 * timed->delay_range_s, timed->clock_ratio));
  return std::move(timed->readings);
}

std::vector<LineReading> take_interval(const std::vector<LineReading>& readings, const TimeInterval& interval,
                                       const IntervalNames& names) {
  std::vector<LineReading> taken;
  for (const LineReading& reading : readings) {
    const double t = seconds_of(reading.time);
    if (t >= start_of(interval) && t < end_of(interval)) taken.push_back(reading);
  }
  if (taken.empty() && !readings.empty()) {
    throw InputError(names.source, 0,
                     fmt::format("no reading from {:g} to {:g} s; the recording spans {}", start_of(interval),
                                 end_of(interval), span_of(readings)),
                     fmt::format("change {} or {}", names.start_flag, names.end_flag));
  }
  return taken;
}

RigidBody choose_body(const std::vector<RigidBody>& bodies, const std::string& name, const std::string& path) {
  if (name.empty() && bodies.size() == 1) return bodies.front();
  std::vector<std::string_view> known;
  for (const RigidBody& body : bodies) {
    if (!name.empty() && body.name == name) return body;
    known.push_back(body.name);
  }
  if (!name.empty()) throw InputError(path, 0, fmt::format("no body '{}'", name), suggest_name(name, known));
  throw InputError(path, 0, fmt::format("holds {} bodies: {}", bodies.size(), fmt::join(known, ", ")),
                   "choose one by --body");
}

void require_station(const DetectorRig& rig, const std::string& name, const std::string& path) {
  if (name.empty()) return;
  std::vector<std::string_view> known;
  for (const LineDetector& detector : rig.detectors) {
    if (detector.station == name) return;
    if (std::find(known.begin(), known.end(), detector.station) == known.end()) known.push_back(detector.station);
  }
  throw InputError(path, 0, fmt::format("no station '{}'", name), suggest_name(name, known));
}

void require_overlap(std::span<const TimedPosition> positions, const std::vector<LineReading>& readings,
                     const std::string& path) {
  if (readings.empty()) return;
  const auto is_within = [&](const TimedPosition& p) {
    return p.time >= readings.front().time && p.time <= readings.back().time;
  };
  if (std::any_of(positions.begin(), positions.end(), is_within)) return;
  throw InputError(
      path, 0,
      fmt::format("no position in the time of the readings, {}; it spans {:.3f} to {:.3f} s", span_of(readings),
                  seconds_of(positions.front().time), seconds_of(positions.back().time)),
      "both must count time from the same moment");
}

}  // namespace alidade
