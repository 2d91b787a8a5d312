// SPDX-License-Identifier: Apache-2.0
#include "io/receiver_reading_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/errors.h"
#include "core/find_by_id.h"
#include "io/table_stream.h"

namespace alidade {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

// Where the columns stand, from 0; −1: not there.
struct Columns {
  int t_ns, t_s, receiver;
  int u, v, azimuth, elevation, azimuth_deg, elevation_deg;
  int sigma_px, sigma_rad, temperature, target;
};

Columns find_columns(const TableStream& table, std::span<const Receiver> receivers) {
  Columns c{};
  c.t_ns = table.find("t_ns");
  c.t_s = c.t_ns < 0 ? table.require("t_s") : -1;
  c.receiver = table.require("receiver");
  const bool has_cameras =
      std::any_of(receivers.begin(), receivers.end(), [](const Receiver& r) { return !!r.camera; });
  const bool has_finders = std::any_of(receivers.begin(), receivers.end(), [](const Receiver& r) { return !r.camera; });
  c.azimuth_deg = table.find("azimuth_deg");
  c.elevation_deg = table.find("elevation_deg");
  const bool is_in_degrees = c.azimuth_deg >= 0 && c.elevation_deg >= 0;
  c.u = has_cameras ? table.require("u_px") : -1;
  c.v = has_cameras ? table.require("v_px") : -1;
  c.azimuth = has_finders && !is_in_degrees ? table.require("azimuth_rad") : -1;
  c.elevation = has_finders && !is_in_degrees ? table.require("elevation_rad") : -1;
  c.sigma_px = table.find("sigma_px");
  c.sigma_rad = table.find("sigma_rad");
  c.temperature = table.find("temperature_k");
  c.target = table.find("target");
  return c;
}

}  // namespace

struct ReceiverReadingReader::State {
  TableStream table;
  Columns columns;
  std::vector<Receiver> receivers;
  RecordingClock::duration most_disorder;
  std::map<int, Timestamp> latest;  // by receiver
  std::int64_t count = 0;

  State(const std::filesystem::path& path, std::span<const Receiver> list, double most_disorder_s, std::stop_token stop)
      : table(path, std::move(stop)),
        columns(find_columns(table, list)),
        receivers(list.begin(), list.end()),
        most_disorder(from_seconds(most_disorder_s)) {}

  const Receiver& receiver() const {
    const int wanted = table.integer(columns.receiver);
    if (const Receiver* found = find_by_id(std::span<const Receiver>(receivers), wanted)) return *found;
    std::vector<int> known;
    for (const Receiver& r : receivers) known.push_back(r.id);
    table.refuse(fmt::format("unknown receiver {}", wanted), list_ids(known));
  }

  Timestamp time(int receiver) {
    const Timestamp t = table.time(columns.t_ns, columns.t_s);
    const auto [last, is_first] = latest.try_emplace(receiver, t);
    if (t < last->second - most_disorder) {
      table.refuse(fmt::format("time of receiver {} goes back from {} s to {} s", receiver,
                               format_seconds(last->second), format_seconds(t)),
                   "sort the readings by time");
    }
    last->second = std::max(last->second, t);
    return t;
  }

  // A lens images nothing so far outside the image; a file of another resolution is noticed by it.
  Eigen::Vector2d pixel(const Camera& camera) const {
    const Eigen::Vector2d p(table.number(columns.u), table.number(columns.v));
    if (!is_inside(camera, p, -0.5)) {
      table.refuse(fmt::format("pixel ({:g}, {:g}) lies outside the image of {}x{} px", p.x(), p.y(), camera.width,
                               camera.height),
                   "are the receivers those of this recording, at its resolution?");
    }
    return p;
  }

  Eigen::Vector2d angles() const {
    const bool is_in_degrees = columns.azimuth < 0;
    Eigen::Vector2d angles(table.number(is_in_degrees ? columns.azimuth_deg : columns.azimuth),
                           table.number(is_in_degrees ? columns.elevation_deg : columns.elevation));
    if (is_in_degrees) angles *= kTurn / 360.0;
    if (std::abs(angles[0]) > kTurn || std::abs(angles[1]) > 0.25 * kTurn + 1e-9) {
      table.refuse(fmt::format("azimuth {:g} rad, elevation {:g} rad is no direction", angles[0], angles[1]),
                   "are these degrees? name the columns azimuth_deg, elevation_deg");
    }
    return angles;
  }

  Eigen::Matrix2d covariance(const Receiver& receiver, const Eigen::Vector2d& value) const {
    const int column = receiver.camera ? columns.sigma_px : columns.sigma_rad;
    if (!table.has(column)) return Eigen::Matrix2d::Zero();
    const double sigma = table.number(column);
    if (!(sigma > 0.0)) table.refuse_cell(column, "> 0");
    Eigen::Vector2d sigmas(sigma, sigma);
    if (!receiver.camera) sigmas[0] /= std::max(1e-6, std::cos(value[1]));  // across the line of sight
    return sigmas.cwiseAbs2().asDiagonal();
  }
};

ReceiverReadingReader::ReceiverReadingReader(const std::filesystem::path& path, std::span<const Receiver> receivers,
                                             double most_disorder_s, std::stop_token stop)
    : state_(std::make_unique<State>(path, receivers, most_disorder_s, std::move(stop))) {}

ReceiverReadingReader::~ReceiverReadingReader() = default;
ReceiverReadingReader::ReceiverReadingReader(ReceiverReadingReader&&) noexcept = default;
ReceiverReadingReader& ReceiverReadingReader::operator=(ReceiverReadingReader&&) noexcept = default;

std::optional<ReceiverReading> ReceiverReadingReader::next() {
  State& s = *state_;
  if (!s.table.next()) return std::nullopt;
  const Receiver& receiver = s.receiver();
  ReceiverReading reading;
  reading.receiver = receiver.id;
  reading.time = s.time(receiver.id);
  reading.value = receiver.camera ? s.pixel(*receiver.camera) : s.angles();
  reading.covariance = s.covariance(receiver, reading.value);
  if (s.table.has(s.columns.temperature)) reading.temperature_k = s.table.number(s.columns.temperature);
  if (s.table.has(s.columns.target)) reading.target = s.table.integer(s.columns.target);
  ++s.count;
  return reading;
}

std::int64_t ReceiverReadingReader::count() const {
  return state_->count;
}

std::int64_t ReceiverReadingReader::bytes() const {
  return state_->table.bytes();
}

std::vector<ReceiverReading> read_receiver_readings(const std::filesystem::path& path,
                                                    std::span<const Receiver> receivers) {
  ReceiverReadingReader reader(path, receivers);
  std::vector<ReceiverReading> readings;
  while (const auto reading = reader.next()) readings.push_back(*reading);
  return readings;
}

}  // namespace alidade
