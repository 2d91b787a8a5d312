// SPDX-License-Identifier: Apache-2.0
#include "app/targets/sky_source.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <map>
#include <utility>

#include "core/errors.h"
#include "core/find_by_id.h"
#include "core/median.h"
#include "datasets/flight_recording.h"
#include "io/receiver_file.h"
#include "io/receiver_reading_file.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

constexpr double kMostDisorder_s = 1.0;  // of one receiver; the tracker's lag decides what is of use

// The median time between successive frames of each camera, and of these the longest; empty unless all are cameras.
std::optional<double> longest_interval_s(std::span<const Receiver> receivers,
                                         const std::vector<ReceiverReading>& readings) {
  std::map<int, std::vector<Timestamp>> times;
  for (const ReceiverReading& reading : readings) times[reading.receiver].push_back(reading.time);
  double longest = 0.0;
  for (const Receiver& receiver : receivers) {
    if (!receiver.camera) return std::nullopt;
    std::vector<Timestamp>& own = times[receiver.id];
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    std::vector<double> steps;
    for (std::size_t i = 1; i < own.size(); ++i) steps.push_back(to_seconds(own[i] - own[i - 1]));
    if (!steps.empty()) longest = std::max(longest, median(std::move(steps)));
  }
  if (longest <= 0.0) return std::nullopt;
  return longest;
}

// All at once, in order; what ended the file too early comes after them.
class RecordedSky : public SkySource {
 public:
  RecordedSky(std::span<const Receiver> receivers, const std::vector<ReceiverReading>& readings, std::stop_token stop,
              std::optional<InputError> fault = std::nullopt)
      : fault_(std::move(fault)),
        bearings_(bearings_of(receivers, readings)),
        without_direction_(static_cast<std::int64_t>(readings.size() - bearings_.size())),
        frame_interval_s_(longest_interval_s(receivers, readings)),
        stop_(std::move(stop)) {}

  std::optional<Bearing> next() override {
    if (stop_.stop_requested()) return std::nullopt;
    if (next_ < bearings_.size()) return bearings_[next_++];
    if (fault_) throw *fault_;
    return std::nullopt;
  }

  Progress progress() const override {
    return {"tracking (bearings)", static_cast<std::int64_t>(next_), static_cast<std::int64_t>(bearings_.size()), ""};
  }

  std::int64_t without_direction() const override { return without_direction_; }
  std::optional<double> frame_interval_s() const override { return frame_interval_s_; }

 private:
  std::optional<InputError> fault_;
  std::vector<Bearing> bearings_;
  std::int64_t without_direction_;
  std::optional<double> frame_interval_s_;
  std::stop_token stop_;
  std::size_t next_ = 0;
};

std::unique_ptr<SkySource> open_file(const fs::path& path, std::span<const Receiver> receivers, std::stop_token stop) {
  ReceiverReadingReader reader(path, receivers, kMostDisorder_s, stop);
  std::vector<ReceiverReading> readings;
  std::optional<InputError> fault;
  try {
    while (const auto reading = reader.next()) readings.push_back(*reading);
  } catch (const InputError& error) {
    fault = error;
  }
  return std::make_unique<RecordedSky>(receivers, readings, std::move(stop), fault);
}

// Of the form that datasets/flight_recording.h reads.
bool is_flight(const std::string& source) {
  return fs::is_directory(source) && fs::exists(fs::path(source) / "groundtruth.csv");
}

class LiveSky : public SkySource {
 public:
  LiveSky(const std::string& source, std::span<const Receiver> receivers, std::stop_token stop)
      : receivers_(receivers.begin(), receivers.end()), reader_(source, receivers, kMostDisorder_s, std::move(stop)) {
    if (std::ranges::all_of(receivers, [](const Receiver& r) { return r.camera.has_value(); })) listen();
  }

  std::optional<Bearing> next() override {
    while (const auto reading = next_reading()) {
      const Receiver* receiver = find_by_id(std::span<const Receiver>(receivers_), reading->receiver);
      if (const auto bearing = bearing_of(*receiver, *reading)) return bearing;
      ++without_direction_;
    }
    return std::nullopt;
  }

  Progress progress() const override { return {"tracking (bearings)", reader_.count(), 0, ""}; }

  std::int64_t without_direction() const override { return without_direction_; }
  std::optional<double> frame_interval_s() const override { return frame_interval_s_; }

 private:
  // Waits for the readings that tell how fast frames come, and keeps them.
  void listen() {
    constexpr double kEnough_s = 1.0;
    constexpr std::size_t kMost = 10'000;
    try {
      while (first_.size() < kMost) {
        const auto reading = reader_.next();
        if (!reading) break;
        first_.push_back(*reading);
        if (to_seconds(reading->time - first_.front().time) > kEnough_s) break;
      }
    } catch (const InputError& error) {
      fault_ = error;
    }
    frame_interval_s_ = longest_interval_s(receivers_, {first_.begin(), first_.end()});
  }

  std::optional<ReceiverReading> next_reading() {
    if (first_.empty() && fault_) throw *fault_;
    if (first_.empty()) return reader_.next();
    const ReceiverReading reading = first_.front();
    first_.pop_front();
    return reading;
  }

  std::vector<Receiver> receivers_;
  ReceiverReadingReader reader_;
  std::deque<ReceiverReading> first_;
  std::optional<InputError> fault_;
  std::optional<double> frame_interval_s_;
  std::int64_t without_direction_ = 0;
};

}  // namespace

std::vector<Receiver> read_receivers_of(const std::string& source) {
  if (is_flight(source)) return read_flight(source).receivers;
  const fs::path path = fs::is_directory(source) ? fs::path(source) / "receivers.yaml" : fs::path(source);
  return read_receivers(path);
}

std::unique_ptr<SkySource> open_sky(const std::string& source, std::span<const Receiver> receivers,
                                    std::stop_token stop) {
  if (source == "-") return std::make_unique<LiveSky>(source, receivers, std::move(stop));
  if (is_flight(source)) {
    const FlightRecording flight = read_flight(source);
    return std::make_unique<RecordedSky>(receivers, flight.readings, std::move(stop));
  }
  const fs::path path = fs::is_directory(source) ? fs::path(source) / "observations.csv" : fs::path(source);
  return open_file(path, receivers, std::move(stop));
}

}  // namespace alidade
