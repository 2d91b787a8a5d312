// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/recorder_options.h"

#include <stdexcept>

#include <fmt/format.h>

namespace alidade {

void validate(const RecorderOptions& options) {
  if (!(options.busy_share > 0 && options.busy_share <= 1)) {
    throw std::invalid_argument(fmt::format("busy_share must be > 0 and <= 1, got {}", options.busy_share));
  }
  if (!(options.assumed_fps_hz > 0 && options.assumed_fps_hz < 1e6)) {
    throw std::invalid_argument(fmt::format("assumed_fps_hz must be > 0 and < 1e6 Hz, got {}", options.assumed_fps_hz));
  }
  if (options.keep_free_bytes < 0) {
    throw std::invalid_argument(fmt::format("keep_free_bytes must be >= 0, got {}", options.keep_free_bytes));
  }
  if (options.max_bytes && *options.max_bytes <= 0) {
    throw std::invalid_argument(fmt::format("max_bytes must be > 0, got {}", *options.max_bytes));
  }
  if (!(options.writeback_s > 0 && options.writeback_s < 1e6)) {
    throw std::invalid_argument(fmt::format("writeback_s must be > 0 and < 1e6 s, got {}", options.writeback_s));
  }
}

}  // namespace alidade
