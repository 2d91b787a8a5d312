// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "capture/v4l2/v4l2_device.h"

namespace alidade {

/// Memory of a driver, mapped; unmapped with its owner.
class Mapping {
 public:
  /// Throws CameraError.
  Mapping(const V4l2Device& device, std::size_t length, std::uint32_t offset);
  ~Mapping();
  Mapping(Mapping&& other) noexcept;
  Mapping& operator=(Mapping&&) = delete;

  std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
  std::span<std::uint8_t> bytes_;
};

/// A buffer that the driver filled.
struct V4l2Filled {
  std::uint32_t index = 0;
  std::uint32_t flags = 0;     ///< V4L2_BUF_FLAG_...
  std::uint32_t sequence = 0;  ///< the driver's count
  std::chrono::nanoseconds time{};
  std::vector<std::span<const std::uint8_t>> planes;  ///< what was filled of each; valid until the buffer is given back
};

/// Buffers of a device, mapped and streaming from construction to destruction.
class V4l2Stream {
 public:
  /// `buffers`: how many to ask for; the driver may give another number. Throws CameraError. `device` must outlive it.
  V4l2Stream(const V4l2Device& device, int buffers);
  ~V4l2Stream();
  V4l2Stream(const V4l2Stream&) = delete;
  V4l2Stream& operator=(const V4l2Stream&) = delete;

  /// The next filled buffer, if there is one. Throws CameraError (Gone) for any fault.
  std::optional<V4l2Filled> take();

  /// Lends the buffer to the driver again. One that it does not want now is offered again at the next take(), which
  /// throws if it still is not wanted.
  void give_back(std::uint32_t index);

  /// The flags of all buffers: what their times mean.
  std::uint32_t flags() const { return flags_; }

 private:
  void map_buffers(std::uint32_t count);
  int queue(std::uint32_t index);
  void stop();

  const V4l2Device& device_;
  std::vector<std::vector<Mapping>> buffers_;  ///< planes of each
  std::vector<std::uint32_t> unwanted_;
  std::uint32_t flags_ = 0;
};

}  // namespace alidade
