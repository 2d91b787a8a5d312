// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "capture/frame_source.h"

namespace alidade::test {

/// What the camera did: the truth that a client is held against.
struct LoggedFrame {
  int acquisition = 0;            ///< counts the starts of the acquisition from 1
  std::uint64_t frame = 0;        ///< counts the exposures of the acquisition from 0
  std::uint16_t id = 0;           ///< as sent: 1 to 65535, over and over
  std::uint32_t picture = 0;      ///< what it shows
  std::uint64_t device_time = 0;  ///< ns of the camera's clock, at the start of the exposure
  HostTime host_time{};           ///< the same moment on the host's clock
  std::chrono::nanoseconds exposure{};
  bool is_dropped = false;  ///< counted, but never sent

  friend bool operator==(const LoggedFrame&, const LoggedFrame&) = default;
};

/// Writes the log, a CSV, each line at once so that it survives a kill.
class CameraLog {
 public:
  /// Throws DeviceError where the file cannot be written.
  explicit CameraLog(const std::filesystem::path& path);

  void add(const LoggedFrame& frame);

 private:
  std::ofstream file_;
};

/// The log so far; a line that a kill cut off is left out. Throws InputError where there is none.
std::vector<LoggedFrame> read_camera_log(const std::filesystem::path& path);

}  // namespace alidade::test
