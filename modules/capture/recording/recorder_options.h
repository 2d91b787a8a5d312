// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "io/lossless_format.h"

namespace alidade {

/// How a recording is written.
struct RecorderOptions {
  std::optional<LosslessCodec> codec;  ///< empty: the one of the smallest file that keeps up with the camera
  /// Of the frame period that packing may take when the codec is chosen: the rest is for the disk and for all else that
  /// the machine does. Divide it among cameras that record at once.
  double busy_share = 0.5;
  double assumed_fps_hz = 30;  ///< of a camera that does not tell its rate (a trigger sets it)
  /// The recording stops before the disk has less than this, so that it can be closed and the system goes on working.
  std::int64_t keep_free_bytes = 256 << 20;
  std::optional<std::int64_t> max_bytes;  ///< of this recording; it stops before it is larger
  /// How often what is written is sent on to the disk: a power cut loses about as much, a killed program nothing.
  double writeback_s = 1;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const RecorderOptions& options);

}  // namespace alidade
