// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "capture/capture_event.h"
#include "capture/frame_source.h"
#include "tests/faults/v4l2/loop_output.h"

namespace alidade::test {

/// Frames that went through the machine's video output and came back from its camera, from the first to the last one
/// shown. Both run at the same rate, each by its own clock: a frame may come twice or be missed, and shown() says which
/// came.
class LoopedFrames : public FrameSource {
 public:
  /// `frames` must outlive it. Throws CameraError.
  LoopedFrames(const RawFrames& frames, CaptureEventSink events);

  using FrameSource::next;
  std::optional<Frame> next(std::stop_token stop) override;
  std::optional<int> frame_count() const override { return std::nullopt; }
  bool has_times() const override { return true; }
  std::string describe() const override { return camera_->describe(); }

  /// What the camera granted.
  const CameraFacts& camera() const { return facts_; }

  /// For each frame given, which one of `frames` it is; -1 for one that is none of them.
  const std::vector<int>& shown() const { return shown_; }

 private:
  int identify(const Frame& frame) const;

  RawFrames frames_;
  LoopOutput output_;
  CameraFacts facts_;  ///< of the opening of camera_, which is made after it
  std::unique_ptr<FrameSource> camera_;
  std::vector<int> shown_;
  int last_ = 0;          ///< frame seen last
  std::jthread showing_;  ///< after what it uses
};

}  // namespace alidade::test
