// SPDX-License-Identifier: Apache-2.0
#include "io/reading_file.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/errors.h"
#include "io/reading_columns.h"

namespace alidade {
namespace {

constexpr double kNormalTolerance = 1e-3;  // of a normal's length: rounded to three digits
constexpr double kCentreTolerance = 1e-3;  // m; planes of another calibration of the detector miss its centre by cm

}  // namespace

struct ReadingReader::State {
  TableStream table;
  ReadingColumns columns;
  std::vector<LineDetector> detectors;  // in order of id
  std::vector<int> markers;             // in order
  Timestamp last_time = Timestamp::min();
  std::int64_t count = 0;

  State(const std::filesystem::path& path, std::span<const LineDetector> rig, std::span<const RigidBody> bodies,
        std::stop_token stop)
      : table(path, std::move(stop)), columns(find_reading_columns(table)), detectors(rig.begin(), rig.end()) {
    std::sort(detectors.begin(), detectors.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    for (const RigidBody& body : bodies) {
      for (const BodyMarker& marker : body.markers) markers.push_back(marker.id);
    }
    std::sort(markers.begin(), markers.end());
  }

  Timestamp time() {
    const Timestamp t = table.time(columns.t_ns, columns.t_s);
    if (t < last_time) {
      table.refuse(fmt::format("time goes back from {} s to {} s", format_seconds(last_time), format_seconds(t)),
                   "sort the readings by time");
    }
    last_time = t;
    return t;
  }

  const LineDetector& detector() const {
    const int wanted = table.integer(columns.detector);
    const auto found = std::lower_bound(detectors.begin(), detectors.end(), wanted,
                                        [](const LineDetector& d, int i) { return d.id < i; });
    if (found != detectors.end() && found->id == wanted) return *found;
    std::vector<int> known;
    for (const LineDetector& d : detectors) known.push_back(d.id);
    table.refuse(fmt::format("unknown detector {}", wanted), list_ids(known));
  }

  int marker() const {
    const int wanted = table.integer(columns.marker);
    if (std::binary_search(markers.begin(), markers.end(), wanted)) return wanted;
    table.refuse(fmt::format("marker {} belongs to no body", wanted), list_ids(markers));
  }

  double value_of_plane(const LineDetector& detector) const {
    Plane plane{{table.number(columns.plane[0]), table.number(columns.plane[1]), table.number(columns.plane[2])}, 0.0};
    const double length = plane.normal.norm();
    if (!(std::abs(length - 1.0) <= kNormalTolerance)) {
      table.refuse(fmt::format("the plane's normal must be of length 1, got {:.6g}", length),
                   "divide nx, ny, nz, d_m by it");
    }
    plane.offset = table.number(columns.plane[3]) / length;
    plane.normal /= length;
    const double miss = distance(plane, centre_world(detector));
    if (!(std::abs(miss) <= kCentreTolerance)) {
      table.refuse(
          fmt::format("the plane misses the centre of detector {} by {:.1f} mm", detector.id, 1e3 * std::abs(miss)),
          "give planes of the same detector poses, or 'angle_raw_rad'");
    }
    const auto value = value_of(detector, plane);
    if (!value) table.refuse(fmt::format("detector {} sees no point of the plane's axis", detector.id), "");
    return *value;
  }

  double value(const LineDetector& detector) const {
    const bool pixels = reads_pixels(detector.model);
    const int column = pixels ? columns.value_px : columns.value_rad;
    if (table.has(column)) return table.number(column);
    if (columns.plane[0] >= 0) return value_of_plane(detector);
    table.refuse(fmt::format("has no reading of detector {}", detector.id),
                 pixels ? "it reads pixels: 'value_px' is wanted" : "it reads angles: 'angle_raw_rad' is wanted");
  }

  double sigma(const LineDetector& detector) const {
    const int column = reads_pixels(detector.model) ? columns.sigma_px : columns.sigma_rad;
    if (!table.has(column)) return 0.0;
    const double s = table.number(column);
    if (!(s > 0)) table.refuse_cell(column, "> 0");
    return s;
  }
};

ReadingReader::ReadingReader(const std::filesystem::path& path, std::span<const LineDetector> detectors,
                             std::span<const RigidBody> bodies, std::stop_token stop)
    : state_(std::make_unique<State>(path, detectors, bodies, std::move(stop))) {}

ReadingReader::~ReadingReader() = default;
ReadingReader::ReadingReader(ReadingReader&&) noexcept = default;
ReadingReader& ReadingReader::operator=(ReadingReader&&) noexcept = default;

std::optional<LineReading> ReadingReader::next() {
  if (!state_->table.next()) return std::nullopt;
  LineReading reading;
  reading.time = state_->time();
  const LineDetector& detector = state_->detector();
  reading.detector = detector.id;
  reading.marker = state_->marker();
  reading.value = state_->value(detector);
  reading.sigma = state_->sigma(detector);
  ++state_->count;
  return reading;
}

std::int64_t ReadingReader::count() const {
  return state_->count;
}

std::int64_t ReadingReader::bytes() const {
  return state_->table.bytes();
}

}  // namespace alidade
