// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "capture/camera_device.h"
#include "capture/capture_event.h"
#include "capture/live_camera.h"

namespace alidade::test {

/// A frame of a test camera that showed the pattern, as it came.
struct SeenFrame {
  HostTime arrival{};  ///< out of the source
  Timestamp time{};
  CaptureStamp stamp;
  std::optional<std::uint32_t> picture;  ///< as spelt in its pixels
  bool is_exact = false;                 ///< every pixel is as the pattern has it
};

/// A live GenICam camera at work in a thread, with all that came of it.
class LiveCapture {
 public:
  /// Throws CameraError as the first opening does.
  LiveCapture(const std::string& address, const CameraRequest& request, const LiveCameraOptions& options = {});
  ~LiveCapture();

  /// The first undamaged frame that came out after `after`; empty where none did within `patience`.
  std::optional<SeenFrame> wait_for_frame(HostTime after, std::chrono::milliseconds patience);
  /// The same for an event of one of these kinds.
  std::optional<CaptureEvent> wait_for_event(std::initializer_list<CaptureEventKind> kinds, HostTime after,
                                             std::chrono::milliseconds patience);
  /// Until there are so many frames in all, damaged ones included; false where there were not within `patience`.
  bool wait_for_count(std::size_t count, std::chrono::milliseconds patience);

  std::vector<SeenFrame> frames() const;
  std::vector<CaptureEvent> events() const;

  /// Closes the camera.
  void stop();

 private:
  void read(const std::stop_token& stop);

  mutable std::mutex mutex_;  // of these
  std::condition_variable changed_;
  std::vector<SeenFrame> frames_;
  std::vector<CaptureEvent> events_;

  std::unique_ptr<FrameSource> source_;
  std::jthread reader_;
};

}  // namespace alidade::test
