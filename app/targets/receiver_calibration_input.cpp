// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_input.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "app/targets/sky_source.h"
#include "core/errors.h"
#include "core/find_by_id.h"
#include "datasets/flight_recording.h"
#include "io/position_file.h"
#include "io/receiver_reading_file.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

double seconds_of(Timestamp time) {
  return to_seconds(time.time_since_epoch());
}

bool is_flight(const std::string& source) {
  return fs::is_directory(source) && fs::exists(fs::path(source) / "groundtruth.csv");
}

// What the observations are called in messages.
std::string name_of_observations(const ReceiverCalibrationSources& sources) {
  const std::string& source = sources.observations.empty() ? sources.receivers : sources.observations;
  return fs::is_directory(source) ? (fs::path(source) / "observations.csv").string() : source;
}

std::vector<ReceiverReading> read_observations(const ReceiverCalibrationSources& sources,
                                               const std::vector<Receiver>& receivers) {
  if (sources.observations.empty() && !fs::is_directory(sources.receivers)) {
    throw InputError(sources.receivers, 0, "no observations are given",
                     "name a CSV of observations after it, or a folder that holds both");
  }
  const std::string& source = sources.observations.empty() ? sources.receivers : sources.observations;
  if (!is_flight(source)) return read_receiver_readings(name_of_observations(sources), receivers);
  std::vector<ReceiverReading> readings = read_flight(source).readings;
  for (const ReceiverReading& reading : readings) {
    if (find_by_id(std::span<const Receiver>(receivers), reading.receiver)) continue;
    throw InputError(sources.receivers, 0, fmt::format("has no receiver {}, which observed", reading.receiver),
                     "name the receivers of this flight");
  }
  return readings;
}

std::vector<TimedPosition> read_truth(const std::string& source) {
  const fs::path simulated = fs::path(source) / "truth.csv";
  std::vector<TimedPosition> truth = is_flight(source)
                                         ? read_flight(source).truth
                                         : read_positions(fs::exists(simulated) ? simulated : fs::path(source));
  constexpr std::size_t kLeast = 4;  // a curve through the positions takes them
  if (truth.size() < kLeast) {
    throw InputError(source, 0, fmt::format("holds {} positions, wanted are {} or more", truth.size(), kLeast),
                     "give the target's path while the receivers watched it");
  }
  for (std::size_t i = 1; i < truth.size(); ++i) {
    if (truth[i].time > truth[i - 1].time) continue;
    throw InputError(source, 0, fmt::format("two positions at {:.3f} s", seconds_of(truth[i].time)),
                     "give the path of one target, one position at a time");
  }
  return truth;
}

struct Span {
  double first_s = std::numeric_limits<double>::infinity(), last_s = -std::numeric_limits<double>::infinity();
  void extend(double t_s) { first_s = std::min(first_s, t_s), last_s = std::max(last_s, t_s); }
  std::string text() const { return fmt::format("{:.3f} to {:.3f} s", first_s, last_s); }
};

double common_s(const std::vector<Receiver>& receivers, const ReceiverReading& reading) {
  const Receiver* receiver = find_by_id(std::span<const Receiver>(receivers), reading.receiver);
  return seconds_of(common_time(receiver->clock, reading.time));
}

// Of the interval, and of cameras alone.
void take_interval(ReceiverCalibrationInput& input) {
  const double begin_s = input.sources.start_s.value_or(-std::numeric_limits<double>::infinity());
  const double end_s = input.sources.end_s.value_or(std::numeric_limits<double>::infinity());
  Span all;
  std::erase_if(input.readings, [&](const ReceiverReading& reading) {
    if (!find_by_id(std::span<const Receiver>(input.receivers), reading.receiver)->camera) return true;
    const double t_s = common_s(input.receivers, reading);
    all.extend(t_s);
    return t_s < begin_s || t_s >= end_s;
  });
  if (!input.readings.empty()) return;
  const std::string source = name_of_observations(input.sources);
  if (all.first_s > all.last_s) throw InputError(source, 0, "holds no reading of a camera", "record a flying target");
  throw InputError(source, 0,
                   fmt::format("no reading from {:g} to {:g} s; the cameras' span {}", begin_s, end_s, all.text()),
                   "change --start-s or --end-s");
}

void check_targets(const ReceiverCalibrationInput& input) {
  std::set<int> targets;
  for (const ReceiverReading& reading : input.readings) {
    if (reading.target >= 0) targets.insert(reading.target);
  }
  if (targets.size() < 2) return;
  throw InputError(name_of_observations(input.sources), 0, fmt::format("holds {} targets", targets.size()),
                   "a calibration goes by one; keep its rows alone");
}

void check_overlap(const ReceiverCalibrationInput& input) {
  Span readings;
  const double begin_s = seconds_of(input.truth.front().time), end_s = seconds_of(input.truth.back().time);
  for (const ReceiverReading& reading : input.readings) readings.extend(common_s(input.receivers, reading));
  if (readings.first_s < end_s && readings.last_s > begin_s) return;
  throw InputError(input.sources.truth, 0,
                   fmt::format("spans {:.3f} to {:.3f} s, the observations {}", begin_s, end_s, readings.text()),
                   "both must count time by one clock; correct the receivers' clocks (offset_s), or --start-s and "
                   "--end-s");
}

void check_cameras(const ReceiverCalibrationInput& input) {
  std::set<int> seeing;
  for (const ReceiverReading& reading : input.readings) seeing.insert(reading.receiver);
  if (seeing.size() >= 2) return;
  throw InputError(name_of_observations(input.sources), 0, "holds readings of one camera",
                   "without --truth two cameras or more must see the target; give its path, or add a camera");
}

}  // namespace

std::vector<Receiver> ReceiverCalibrationInput::cameras() const {
  std::vector<Receiver> cameras;
  std::copy_if(receivers.begin(), receivers.end(), std::back_inserter(cameras),
               [](const Receiver& receiver) { return receiver.camera.has_value(); });
  return cameras;
}

ReceiverCalibrationInput read_calibration_input(const ReceiverCalibrationSources& sources) {
  ReceiverCalibrationInput input;
  input.sources = sources;
  input.receivers = read_receivers_of(sources.receivers);
  if (input.cameras().empty()) {
    throw InputError(sources.receivers, 0, "holds direction finders alone; only cameras can be calibrated",
                     "name receivers with cameras");
  }
  input.readings = read_observations(sources, input.receivers);
  take_interval(input);
  check_targets(input);
  std::stable_sort(input.readings.begin(), input.readings.end(), [](const auto& a, const auto& b) {
    return a.receiver != b.receiver ? a.receiver < b.receiver : a.time < b.time;
  });
  if (sources.truth.empty()) {
    check_cameras(input);
    return input;
  }
  input.truth = read_truth(sources.truth);
  check_overlap(input);
  return input;
}

}  // namespace alidade
