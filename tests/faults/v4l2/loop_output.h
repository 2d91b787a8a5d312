// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include "capture/camera_device.h"
#include "capture/v4l2/v4l2_device.h"
#include "capture/v4l2/v4l2_stream.h"

namespace alidade::test {

/// Frames of one size and V4L2 format ("GREY", "YUYV"), one behind the other without padding.
struct RawFrames {
  std::span<const std::uint8_t> bytes;
  cv::Size size;
  std::string format;
  bool is_slow = false;  ///< shown at 14.4 Hz instead of 30, for a machine that has much to do

  std::size_t frame_bytes() const;
  int count() const { return static_cast<int>(bytes.size() / frame_bytes()); }
  std::span<const std::uint8_t> frame(int index) const;
};

/// The machine's video output, looped back into its HDMI camera byte by byte. Shows the first frame until
/// show_all(), then each for one period, and the last from then on.
class LoopOutput {
 public:
  /// `frames` must outlive it. Throws CameraError.
  explicit LoopOutput(const RawFrames& frames);
  ~LoopOutput();
  LoopOutput(const LoopOutput&) = delete;
  LoopOutput& operator=(const LoopOutput&) = delete;

  /// Returns when the last frame waits to be shown, or soon after `stop` was requested.
  void show_all(std::stop_token stop);

 private:
  void queue(std::uint32_t buffer, int frame);
  std::uint32_t free_buffer(std::stop_token stop);

  RawFrames frames_;
  V4l2Device device_;
  std::vector<Mapping> buffers_;
  std::uint32_t unused_ = 0;  ///< the first buffer that was never queued
};

/// What to ask of the camera that shows the output.
CameraRequest loop_request(const RawFrames& frames);

}  // namespace alidade::test
