// SPDX-License-Identifier: Apache-2.0
#include "app/targets/sky_source.h"

#include <filesystem>
#include <utility>

#include "core/find_by_id.h"
#include "datasets/flight_recording.h"
#include "io/receiver_file.h"
#include "io/receiver_reading_file.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

// All at once, in order.
class RecordedSky : public SkySource {
 public:
  RecordedSky(std::span<const Receiver> receivers, std::span<const ReceiverReading> readings, std::stop_token stop)
      : bearings_(bearings_of(receivers, readings)),
        without_direction_(static_cast<std::int64_t>(readings.size() - bearings_.size())),
        stop_(std::move(stop)) {}

  std::optional<Bearing> next() override {
    if (next_ == bearings_.size() || stop_.stop_requested()) return std::nullopt;
    return bearings_[next_++];
  }

  Progress progress() const override {
    return {"tracking (bearings)", static_cast<std::int64_t>(next_), static_cast<std::int64_t>(bearings_.size()), ""};
  }

  std::int64_t without_direction() const override { return without_direction_; }

 private:
  std::vector<Bearing> bearings_;
  std::int64_t without_direction_;
  std::stop_token stop_;
  std::size_t next_ = 0;
};

// Of the form that datasets/flight_recording.h reads.
bool is_flight(const std::string& source) {
  return fs::is_directory(source) && fs::exists(fs::path(source) / "groundtruth.csv");
}

class LiveSky : public SkySource {
 public:
  LiveSky(const std::string& source, std::span<const Receiver> receivers, std::stop_token stop)
      : receivers_(receivers.begin(), receivers.end()), reader_(source, receivers, kMostDisorder_s, std::move(stop)) {}

  std::optional<Bearing> next() override {
    while (const auto reading = reader_.next()) {
      const Receiver* receiver = find_by_id(std::span<const Receiver>(receivers_), reading->receiver);
      if (const auto bearing = bearing_of(*receiver, *reading)) return bearing;
      ++without_direction_;
    }
    return std::nullopt;
  }

  Progress progress() const override { return {"tracking (bearings)", reader_.count(), 0, ""}; }

  std::int64_t without_direction() const override { return without_direction_; }

 private:
  static constexpr double kMostDisorder_s = 1.0;  // of one receiver; the tracker's lag decides what is of use

  std::vector<Receiver> receivers_;
  ReceiverReadingReader reader_;
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
  return std::make_unique<RecordedSky>(receivers, read_receiver_readings(path, receivers), std::move(stop));
}

}  // namespace alidade
