// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "camera/receiver.h"
#include "io/atomic_file.h"

namespace alidade {

/// Reads what receivers report, row by row and in bounded memory, from a CSV file of any length or from standard input
/// ("-", a live feed). The first line names the columns; others than these are passed over:
/// - `t_ns` or `t_s`: the time by the receiver's own clock; of one receiver it goes back by `most_disorder_s` at most;
/// - `receiver`: its id;
/// - `u_px`, `v_px` of cameras; `azimuth_rad`, `elevation_rad` (or both in `_deg`) of direction finders, see Receiver;
/// - `sigma_px`, `sigma_rad`: of each coordinate; may be left out, or empty (the receiver's);
/// - `temperature_k`, may be left out or empty; `target`: which one it is of, where that is known (−1, empty: not).
class ReceiverReadingReader {
 public:
  /// Throws InputError for a file that cannot be opened, is empty, or whose columns are not those above.
  ReceiverReadingReader(const std::filesystem::path& path, std::span<const Receiver> receivers,
                        double most_disorder_s = 1.0, std::stop_token stop = {});
  ~ReceiverReadingReader();
  ReceiverReadingReader(ReceiverReadingReader&&) noexcept;
  ReceiverReadingReader& operator=(ReceiverReadingReader&&) noexcept;

  /// The next reading, waiting for it if need be; empty at the end, and once a stop is requested. Throws InputError
  /// with the line for an unknown receiver, what is no finite number, an angle beyond a turn (degrees?), a pixel far
  /// outside the image, a time that goes back, and a row that is cut off.
  std::optional<ReceiverReading> next();

  /// Readings given out so far.
  std::int64_t count() const;

  /// How far into the stream that is, in bytes.
  std::int64_t bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// All readings of a file. Throws as ReceiverReadingReader.
std::vector<ReceiverReading> read_receiver_readings(const std::filesystem::path& path,
                                                    std::span<const Receiver> receivers);

/// Writes readings that ReceiverReadingReader gives back exactly, but for correlated covariances: t_ns, receiver,
/// target, u_px, v_px, sigma_px (where there are cameras), azimuth_rad, elevation_rad, sigma_rad (direction finders),
/// temperature_k. The file is there once commit returned. Throws DeviceError as AtomicFile does.
class ReceiverReadingWriter {
 public:
  ReceiverReadingWriter(const std::filesystem::path& path, std::span<const Receiver> receivers);

  /// Throws std::invalid_argument for a receiver that was not named.
  void write(const ReceiverReading& reading);
  void commit() { file_.commit(); }

 private:
  AtomicFile file_;
  std::vector<Receiver> receivers_;
  bool has_cameras_, has_finders_;
};

}  // namespace alidade
