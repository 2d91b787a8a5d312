// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "camera/receiver.h"
#include "core/progress.h"

namespace alidade {

/// Lines of sight from wherever they come, as an estimator wants them.
class SkySource {
 public:
  virtual ~SkySource() = default;

  /// The next bearing, by the common clock: of files in order of time, of a live feed as it comes. Empty at the end,
  /// and once a stop is requested. Throws InputError where what comes next cannot be read.
  virtual std::optional<Bearing> next() = 0;

  /// How far that is.
  virtual Progress progress() const = 0;

  /// The time between a camera's frames, of the slowest one; empty where receivers look as they please.
  virtual std::optional<double> frame_interval_s() const { return std::nullopt; }

  /// Readings so far that have no direction: their pixels lie where the lens's model does not reach.
  virtual std::int64_t without_direction() const { return 0; }

  /// At the end: what was cut short or lost on the way, "cam0.mp4: is cut off after 37 frames".
  virtual std::vector<std::string> losses() const { return {}; }
};

/// The receivers of a file, or of a folder: a recorded flight (datasets/flight_recording.h) or a result of
/// `simulate targets`, whose receivers.yaml it is.
std::vector<Receiver> read_receivers_of(const std::string& source);

/// A CSV file of observations, which is read whole and put in order of the common clock (100 bytes each); standard
/// input ("-"), which is taken as it comes, of cameras once the first second has told how fast their frames come; or a
/// folder with both receivers and observations. Throws InputError for what cannot be opened; of a file that is damaged
/// somewhere next() gives what lies before first.
std::unique_ptr<SkySource> open_sky(const std::string& source, std::span<const Receiver> receivers,
                                    std::stop_token stop);

}  // namespace alidade
