// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>

#include <opencv2/core/mat.hpp>

#include "capture/pixel_format.h"
#include "core/time.h"

namespace alidade {

/// The host's clock: monotonic, shared by all programs of the machine (Linux: CLOCK_MONOTONIC), in nanoseconds.
using HostClock = std::chrono::steady_clock;
using HostTime = HostClock::time_point;

/// How a frame came out of a camera; files have none of it but what a recording kept.
struct CaptureStamp {
  std::optional<Timestamp>
      device_time{};                    ///< as the driver or the camera stamped it; CameraFacts::clock names its clock
  std::optional<HostTime> host_time{};  ///< when its first bytes were seen on this machine, as well as that is known
  std::optional<std::uint64_t> sequence{};  ///< the device's own count; starts anew when the device does
  std::uint64_t dropped_before =
      0;  ///< frames that the device counted between the last one and this, and that never came
  std::uint64_t discarded_before =
      0;                    ///< frames that came, and that our own queue gave up since its reader was too slow
  bool is_damaged = false;  ///< the driver says the content is wrong, or parts of it are missing
};

/// An image and its moment. The pixels are never written after the frame is handed out.
struct Frame {
  int index = 0;     ///< counts the frames of the source from 0
  Timestamp time{};  ///< of a live camera: the host's clock, mid-exposure where the exposure is known; see has_times
  std::string name;  ///< file name of the image without its folder; of a video or camera "NAME#index"
  cv::Mat image;     ///< all of one size; laid out as `format` says
  PixelFormat format{};  ///< out of decoded() and of files: 8 bits, grey or BGR
  CaptureStamp stamp{};
};

/// Where images come from, in order of time: files, a video, a recording, a camera. Not for several threads at once.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The next frame, waiting for it if need be; empty at the end, or soon after `stop` was requested. Throws InputError
  /// for an image that is damaged or of another size than the first, DeviceError for a camera that failed for good.
  virtual std::optional<Frame> next(std::stop_token stop) = 0;
  std::optional<Frame> next() { return next(std::stop_token{}); }

  /// Frames in all; empty where that is not known beforehand.
  virtual std::optional<int> frame_count() const = 0;

  /// Whether the times were measured (or follow from a known frame rate); if not, they count the frames, 1 s each.
  virtual bool has_times() const = 0;

  /// What it is, for the report: "400 images in seven-scenes".
  virtual std::string describe() const = 0;

  /// Once next() has given its last frame: what cut the source short or was lost on the way ("... is cut off after 37
  /// of 100 frames"); empty where all is well.
  virtual std::optional<std::string> fault() const { return std::nullopt; }
};

}  // namespace alidade
