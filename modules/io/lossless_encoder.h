// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string_view>

#include <opencv2/core/mat.hpp>

#include "io/lossless_format.h"
#include "io/matroska_header.h"

namespace alidade {

/// Packs frames, each by itself, so that every bit comes back.
class LosslessEncoder {
 public:
  /// Throws std::invalid_argument as validate() does.
  explicit LosslessEncoder(const LosslessFormat& format);
  ~LosslessEncoder();
  LosslessEncoder(LosslessEncoder&&) noexcept;
  LosslessEncoder& operator=(LosslessEncoder&&) noexcept;

  /// The packet of a frame of the type and size that the layout says (else std::invalid_argument), valid until the next
  /// call.
  std::string_view encode(const cv::Mat& image);

  /// What a file says of the video; `period` between two frames, where it is known.
  MatroskaTrack track(std::optional<std::chrono::nanoseconds> period) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alidade
