// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>

#include "camera/line_detector.h"
#include "camera/measurement.h"
#include "geometry/rigid_body.h"
#include "io/atomic_file.h"

namespace alidade {

/// Reads what line detectors read of markers, row by row and in bounded memory, from a CSV file of any length or from
/// standard input ("-", a live feed: a row is given out as soon as its line is complete). The first line names the
/// columns; others than these are passed over:
/// - `t_ns` or `t_s`: the time of the reading itself; never less than in the row before;
/// - `detector`, `marker`: ids;
/// - `angle_raw_rad` (or `value_rad`) for detectors that read angles, `value_px` for those that read pixels; a file
/// with
///   neither has a plane of the world instead, `nx,ny,nz,d_m` with n · p = d: its normal is of unit length within 1e-3,
///   it passes the detector's centre within 1 mm, and it becomes the reading of the detector's model at elevation 0;
/// - `sigma_rad`, `sigma_px`: the reading's standard deviation; may be left out, or empty (the detector's).
class ReadingReader {
 public:
  /// Readings of `detectors` and markers of `bodies`. Throws InputError for a file that cannot be opened, is empty, or
  /// whose columns are not those above.
  ReadingReader(const std::filesystem::path& path, std::span<const LineDetector> detectors,
                std::span<const RigidBody> bodies, std::stop_token stop = {});
  ~ReadingReader();
  ReadingReader(ReadingReader&&) noexcept;
  ReadingReader& operator=(ReadingReader&&) noexcept;

  /// The next reading, waiting for it if need be; empty at the end, and once a stop is requested. Throws InputError
  /// with the line for an unknown id, what is no finite number, a time that goes back, a plane that is none of the
  /// detector's, and a row that is cut off.
  std::optional<LineReading> next();

  /// Readings given out so far.
  std::int64_t count() const;

  /// How far into the stream that is, in bytes.
  std::int64_t bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes readings that ReadingReader gives back exactly: t_ns, detector, marker, value_rad and (where a detector reads
/// pixels) value_px; with a column of standard deviations where `with_sigma`. The file is there once commit returned.
/// Throws DeviceError as AtomicFile does.
class ReadingWriter {
 public:
  ReadingWriter(const std::filesystem::path& path, std::span<const LineDetector> detectors, bool with_sigma = false);

  /// Throws std::invalid_argument for a detector that was not named.
  void write(const LineReading& reading);
  void commit() { file_.commit(); }

 private:
  AtomicFile file_;
  std::vector<std::pair<int, bool>> reads_pixels_;  // by detector id, in order
  bool has_pixels_, has_angles_, with_sigma_;
};

}  // namespace alidade
