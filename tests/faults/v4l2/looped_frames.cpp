// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/v4l2/looped_frames.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "capture/live_camera.h"
#include "capture/v4l2/v4l2_camera.h"
#include "tests/faults/v4l2/vivid.h"

namespace alidade::test {
namespace {

std::unique_ptr<FrameSource> camera_of(const RawFrames& frames, CaptureEventSink events, CameraFacts& facts) {
  LiveCameraOptions options;
  options.give_up_s = 10;
  const auto open = [&facts, request = loop_request(frames)] {
    auto camera = open_v4l2(kLoopInput, request);
    facts = camera->facts();
    return camera;
  };
  return open_live_camera(std::string("v4l2:") + kLoopInput, open, options, std::move(events));
}

}  // namespace

LoopedFrames::LoopedFrames(const RawFrames& frames, CaptureEventSink events)
    : frames_(frames), output_(frames), camera_(camera_of(frames, std::move(events), facts_)) {}

// Frames are looked for from the last one on, as far ahead as the machine may ever be held up.
int LoopedFrames::identify(const Frame& frame) const {
  constexpr int kFarthest = 60;
  const std::size_t bytes = frame.image.total() * frame.image.elemSize();
  if (bytes != frames_.frame_bytes()) return -1;
  for (int i = last_; i < std::min(last_ + kFarthest, frames_.count()); ++i) {
    if (std::memcmp(frame.image.data, frames_.frame(i).data(), bytes) == 0) return i;
  }
  return -1;
}

std::optional<Frame> LoopedFrames::next(std::stop_token stop) {
  if (!shown_.empty() && last_ == frames_.count() - 1) return std::nullopt;
  while (auto frame = camera_->next(stop)) {
    const int shown = identify(*frame);
    if (shown_.empty() && shown != 0) continue;  // the camera was there before the output
    if (shown_.empty()) {
      showing_ = std::jthread([this](std::stop_token halt) { output_.show_all(halt); });
      frame->stamp.dropped_before = 0;
    }
    frame->index = static_cast<int>(shown_.size());
    shown_.push_back(shown);
    if (shown >= 0) last_ = shown;
    return frame;
  }
  return std::nullopt;
}

}  // namespace alidade::test
