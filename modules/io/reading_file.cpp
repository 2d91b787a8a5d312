// SPDX-License-Identifier: Apache-2.0
#include "io/reading_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/errors.h"
#include "io/line_stream.h"
#include "io/reading_columns.h"

namespace alidade {
namespace {

constexpr double kNormalTolerance = 1e-3;  // of a normal's length: rounded to three digits
constexpr double kCentreTolerance = 1e-3;  // m; planes of another calibration of the detector miss its centre by cm

// "0, 1, 2, 3" and so on, for a remedy.
std::string list_ids(const std::vector<int>& ids) {
  constexpr std::size_t kMost = 12;
  const std::size_t count = std::min(kMost, ids.size());
  return fmt::format("known are: {}{}", fmt::join(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(count), ", "),
                     count < ids.size() ? ", ..." : "");
}

// Decimal seconds as they are mostly written: digits, a point, at most nine digits. Else the slower parse_seconds.
std::optional<Timestamp> parse_time(std::string_view text) {
  const std::size_t point = text.find('.');
  const std::string_view whole = text.substr(0, point);
  const std::string_view fraction = point == std::string_view::npos ? "" : text.substr(point + 1);
  if (whole.empty() || whole.size() > 9 || fraction.size() > 9) return parse_seconds(text);
  std::int64_t count = 0;
  for (const std::string_view digits : {whole, fraction}) {
    for (const char c : digits) {
      if (c < '0' || c > '9') return parse_seconds(text);
      count = 10 * count + (c - '0');
    }
  }
  for (std::size_t i = fraction.size(); i < 9; ++i) count *= 10;
  return Timestamp(std::chrono::nanoseconds(count));
}

template <typename Number>
std::optional<Number> parse(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

struct ReadingReader::State {
  LineStream stream;
  std::vector<LineDetector> detectors;  // in order of id
  std::vector<int> markers;             // in order
  ReadingColumns columns;
  std::vector<std::string_view> names, cells;
  std::string header;
  Timestamp last_time = Timestamp::min();
  std::int64_t count = 0;
  int line = 0;

  State(const std::filesystem::path& path, std::span<const LineDetector> rig, std::span<const RigidBody> bodies,
        std::stop_token stop)
      : stream(path, std::move(stop)), detectors(rig.begin(), rig.end()) {
    std::sort(detectors.begin(), detectors.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    for (const RigidBody& body : bodies) {
      for (const BodyMarker& marker : body.markers) markers.push_back(marker.id);
    }
    std::sort(markers.begin(), markers.end());
    read_header();
  }

  void read_header() {
    auto first = stream.next();
    if (!first) throw InputError(stream.name(), 0, "is empty", "its first line must name the columns");
    if (first->text.starts_with("\xEF\xBB\xBF")) first->text.remove_prefix(3);
    header = first->text;
    columns = find_reading_columns(stream.name(), first->number, header);
    cells.resize(static_cast<std::size_t>(columns.count));
    names = cells;
    split_cells(header, names);
  }

  [[noreturn]] void refuse(const std::string& what, const std::string& remedy = "") const {
    throw InputError(stream.name(), line, what, remedy);
  }

  std::string_view cell(int column) const { return cells[static_cast<std::size_t>(column)]; }

  [[noreturn]] void refuse_cell(int column, const char* wanted) const {
    refuse(fmt::format("column '{}': '{}' is not {}", names[static_cast<std::size_t>(column)], cell(column), wanted),
           "correct it or leave the row out");
  }

  double number(int column) const {
    const auto value = parse<double>(cell(column));
    if (!value || !std::isfinite(*value)) refuse_cell(column, "a finite number");
    return *value;
  }

  int id(int column) const {
    const auto value = parse<int>(cell(column));
    if (!value) refuse_cell(column, "a whole number");
    return *value;
  }

  Timestamp time() {
    std::optional<Timestamp> t;
    if (columns.t_ns >= 0) {
      if (const auto ns = parse<std::int64_t>(cell(columns.t_ns))) t = Timestamp(std::chrono::nanoseconds(*ns));
    } else {
      t = parse_time(cell(columns.t_s));
    }
    if (!t) refuse_cell(columns.t_ns >= 0 ? columns.t_ns : columns.t_s, "a time");
    if (*t < last_time) {
      refuse(fmt::format("time goes back from {} s to {} s", format_seconds(last_time), format_seconds(*t)),
             "sort the readings by time");
    }
    last_time = *t;
    return *t;
  }

  const LineDetector& detector() const {
    const int wanted = id(columns.detector);
    const auto found = std::lower_bound(detectors.begin(), detectors.end(), wanted,
                                        [](const LineDetector& d, int i) { return d.id < i; });
    if (found != detectors.end() && found->id == wanted) return *found;
    std::vector<int> known;
    for (const LineDetector& d : detectors) known.push_back(d.id);
    refuse(fmt::format("unknown detector {}", wanted), list_ids(known));
  }

  int marker() const {
    const int wanted = id(columns.marker);
    if (std::binary_search(markers.begin(), markers.end(), wanted)) return wanted;
    refuse(fmt::format("marker {} belongs to no body", wanted), list_ids(markers));
  }

  double value_of_plane(const LineDetector& detector) const {
    Plane plane{{number(columns.plane[0]), number(columns.plane[1]), number(columns.plane[2])}, 0.0};
    const double length = plane.normal.norm();
    if (!(std::abs(length - 1.0) <= kNormalTolerance)) {
      refuse(fmt::format("the plane's normal must be of length 1, got {:.6g}", length), "divide nx, ny, nz, d_m by it");
    }
    plane.offset = number(columns.plane[3]) / length;
    plane.normal /= length;
    const double miss = distance(plane, centre_world(detector));
    if (!(std::abs(miss) <= kCentreTolerance)) {
      refuse(fmt::format("the plane misses the centre of detector {} by {:.1f} mm", detector.id, 1e3 * std::abs(miss)),
             "give planes of the same detector poses, or 'angle_raw_rad'");
    }
    const auto value = value_of(detector, plane);
    if (!value) refuse(fmt::format("detector {} sees no point of the plane's axis", detector.id), "");
    return *value;
  }

  double value(const LineDetector& detector) const {
    const bool pixels = reads_pixels(detector.model);
    const int column = pixels ? columns.value_px : columns.value_rad;
    if (column >= 0 && !cell(column).empty()) return number(column);
    if (columns.plane[0] >= 0) return value_of_plane(detector);
    refuse(fmt::format("has no reading of detector {}", detector.id),
           pixels ? "it reads pixels: 'value_px' is wanted" : "it reads angles: 'angle_raw_rad' is wanted");
  }

  double sigma(const LineDetector& detector) const {
    const int column = reads_pixels(detector.model) ? columns.sigma_px : columns.sigma_rad;
    if (column < 0 || cell(column).empty()) return 0.0;
    const double s = number(column);
    if (!(s > 0)) refuse_cell(column, "> 0");
    return s;
  }

  void split(const StreamLine& row) {
    line = row.number;
    const int found = split_cells(row.text, cells);
    if (found == columns.count) return;
    if (!row.has_end) refuse("the last line is cut off", "was the recording broken off? remove the line");
    refuse(fmt::format("has {} cells, the header names {}", found, columns.count), "correct the row or leave it out");
  }
};

ReadingReader::ReadingReader(const std::filesystem::path& path, std::span<const LineDetector> detectors,
                             std::span<const RigidBody> bodies, std::stop_token stop)
    : state_(std::make_unique<State>(path, detectors, bodies, std::move(stop))) {}

ReadingReader::~ReadingReader() = default;
ReadingReader::ReadingReader(ReadingReader&&) noexcept = default;
ReadingReader& ReadingReader::operator=(ReadingReader&&) noexcept = default;

std::optional<LineReading> ReadingReader::next() {
  const auto row = state_->stream.next();
  if (!row) return std::nullopt;
  state_->split(*row);
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
  return state_->stream.bytes();
}

}  // namespace alidade
