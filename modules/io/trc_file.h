// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/time.h"
#include "io/atomic_file.h"

namespace alidade {

/// Writes marker positions frame by frame as TRC, the format of OpenSim and motion capture: tabs, metres, y up. Our
/// world has z up: (x, y, z) becomes (x, z, -y). The head tells how many frames there are, so rows go to a file beside
/// it and follow the head at commit(): memory does not grow. Every call throws DeviceError as AtomicFile does.
class TrcWriter {
 public:
  /// Blanks in marker names become '_'. Throws std::invalid_argument where there is no marker.
  TrcWriter(std::filesystem::path path, std::vector<std::string> marker_names);
  ~TrcWriter();
  TrcWriter(const TrcWriter&) = delete;
  TrcWriter& operator=(const TrcWriter&) = delete;

  /// As many positions (m) as names, in their order; an empty one leaves its cells blank. Frames come in order of time.
  /// Throws std::invalid_argument for another number.
  void write(Timestamp time, std::span<const std::optional<Eigen::Vector3d>> p_world);

  /// The rate in the head is the mean over all frames; 0 where there are fewer than two.
  void commit();

 private:
  std::string head() const;

  std::filesystem::path path_, rows_path_;
  std::vector<std::string> names_;
  AtomicFile rows_;
  std::int64_t count_ = 0;
  Timestamp first_{}, last_{};
};

}  // namespace alidade
