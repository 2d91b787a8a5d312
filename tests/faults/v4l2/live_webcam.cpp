// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/v4l2/live_webcam.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "capture/live_camera.h"
#include "capture/v4l2/v4l2_camera.h"
#include "tests/faults/v4l2/vivid.h"

namespace alidade::test {

LiveWebcam::LiveWebcam(double fps_hz) {
  LiveCameraOptions options;
  options.give_up_s = 10;
  source_ = open_live_camera(
      "webcam", [fps_hz] { return open_v4l2(kWebcam, small_request(fps_hz)); }, options,
      [this](const CaptureEvent& event) { events_.push_back(event); });
}

std::optional<Frame> LiveWebcam::next() {
  try {
    auto frame = source_->next();
    if (frame) last_frame_time_ = HostClock::now();
    return frame;
  } catch (const CameraError& error) {
    ADD_FAILURE() << error.what();
    return std::nullopt;
  }
}

bool LiveWebcam::read(int count) {
  for (int i = 0; i < count; ++i) {
    if (!next()) return false;
  }
  return true;
}

std::optional<CaptureEvent> LiveWebcam::read_past(CaptureEventKind kind, HostTime since) {
  const HostTime deadline = HostClock::now() + std::chrono::seconds(10);
  while (HostClock::now() < deadline && next()) {
    if (const auto event = find(kind, since)) return event;
  }
  ADD_FAILURE() << "no event '" << name_of(kind) << "'";
  return std::nullopt;
}

std::optional<CaptureEvent> LiveWebcam::find(CaptureEventKind kind, HostTime since) const {
  const auto found = std::find_if(events_.begin(), events_.end(),
                                  [&](const CaptureEvent& e) { return e.kind == kind && e.time >= since; });
  return found == events_.end() ? std::nullopt : std::optional(*found);
}

int LiveWebcam::count(CaptureEventKind kind) const {
  return static_cast<int>(
      std::count_if(events_.begin(), events_.end(), [&](const CaptureEvent& event) { return event.kind == kind; }));
}

}  // namespace alidade::test
