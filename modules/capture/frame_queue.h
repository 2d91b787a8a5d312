// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "capture/capture_event.h"
#include "capture/frame_source.h"

namespace alidade {

/// What happens when a frame comes and the queue is full.
enum class WhenFull {
  Block,       ///< the source waits: for files, where nothing may be lost
  DropOldest,  ///< the oldest frame is given up and counted (CaptureStamp::discarded_before): for cameras
};

struct QueueOptions {
  std::size_t capacity = 8;  ///< frames
  WhenFull when_full = WhenFull::Block;
  CaptureEventSink events{};  ///< told of discarded frames; may be empty
};

/// A source that gives the frames of `source` in the same order, but reads them ahead in a thread of its own. An
/// exception of `source` comes out of next() in its place. `source` is read by that thread only.
std::unique_ptr<FrameSource> queued(std::unique_ptr<FrameSource> source, const QueueOptions& options = {});

}  // namespace alidade
