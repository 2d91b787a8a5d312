// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "capture/genicam/aravis_objects.h"

namespace alidade {

/// The stream of `camera`, ready to take frames of `payload_bytes` that come every `period`. Throws CameraError.
GObjectPointer<ArvStream> open_stream(ArvCamera* camera, std::size_t payload_bytes,
                                      std::optional<std::chrono::nanoseconds> period, const std::string& source);

/// What the stream counts of its troubles, for CameraDevice::statistics().
std::vector<std::pair<std::string, std::uint64_t>> stream_statistics(ArvStream* stream);

/// A frame id that no camera gives: that of a buffer whose header never came.
inline constexpr std::uint64_t kNoFrameId = ~std::uint64_t{0};

}  // namespace alidade
