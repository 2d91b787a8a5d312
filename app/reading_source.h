// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "camera/line_detector.h"
#include "camera/measurement.h"
#include "core/progress.h"
#include "geometry/rigid_body.h"

namespace alidade {

/// What became of the spots in a detector's line image.
struct DetectorSignal {
  int detector = 0;
  std::int64_t rows = 0, spots = 0, identified = 0;
};

/// How much of a source was read.
struct SourceExtent {
  std::int64_t done = 0;   ///< bytes
  std::int64_t total = 0;  ///< 0: not known (standard input)
};

/// Readings of markers in order of time, in bounded memory, from wherever they come.
class ReadingSource {
 public:
  virtual ~ReadingSource() = default;

  /// The next reading, waiting for it if need be; empty at the end, and once a stop is requested. Throws InputError
  /// where what comes next cannot be read.
  virtual std::optional<LineReading> next() = 0;

  /// How far that is.
  virtual SourceExtent extent() const = 0;

  /// Whether readings are found in images: they are nowhere else, and worth keeping.
  virtual bool finds_readings() const { return false; }

  /// Of each detector, so far; empty where readings come as such.
  virtual std::vector<DetectorSignal> signals() const { return {}; }
};

/// A CSV file or standard input ("-") of readings (ReadingReader), or a directory of line images (io/line_images.h),
/// whose spots are found and told apart. Throws InputError for what cannot be opened or is not of these detectors and
/// bodies.
std::unique_ptr<ReadingSource> open_readings(const std::string& source, std::span<const LineDetector> detectors,
                                             std::span<const RigidBody> bodies, std::stop_token stop);

/// The same for the user, in kB.
Progress progress_of(const ReadingSource& source, const std::string& stage);

/// Size of a file; 0 where it cannot be told.
std::int64_t file_bytes(const std::filesystem::path& path);

/// What messages call it.
std::string name_of_source(const std::string& source);

}  // namespace alidade
