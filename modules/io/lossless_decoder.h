// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include <opencv2/core/mat.hpp>

#include "io/lossless_format.h"

namespace alidade {

/// Unpacks the frames that LosslessEncoder packed.
class LosslessDecoder {
 public:
  /// `codec_private` as the file says it.
  LosslessDecoder(const LosslessFormat& format, std::string_view codec_private);
  ~LosslessDecoder();
  LosslessDecoder(LosslessDecoder&&) noexcept;
  LosslessDecoder& operator=(LosslessDecoder&&) noexcept;

  /// The frame of a packet; empty where that is damaged so that no frame comes out. (One that does come out of a
  /// damaged packet may be wrong: keep a checksum.)
  std::optional<cv::Mat> decode(std::string_view packet);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alidade
