// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "capture/frame_source.h"

namespace alidade {

/// What can happen to a live camera.
enum class CaptureEventKind {
  Opened,           ///< granted what `detail` says
  Streaming,        ///< its first frame after being opened
  Stalled,          ///< no frame for several periods
  Resumed,          ///< frames come again by themselves
  Disconnected,     ///< the device is gone
  InUse,            ///< another program has it
  OpenFailed,       ///< for another reason
  Restarted,        ///< the device counts its frames or its clock anew
  FramesDropped,    ///< the device counted frames that never came
  FrameDamaged,     ///< a frame came with errors
  FramesDiscarded,  ///< our queue gave up frames since its reader was too slow
  Closed,
};

/// "stalled", "disconnected", ...
std::string_view name_of(CaptureEventKind kind);

/// The event of that name; empty where there is none.
std::optional<CaptureEventKind> parse_capture_event_kind(std::string_view name);

struct CaptureEvent {
  CaptureEventKind kind = CaptureEventKind::Opened;
  HostTime time{};
  std::string source;  ///< as the user named it
  int frame = 0;       ///< index of the next frame of the source
  std::string detail;  ///< "no frame for 133 ms", "3 frames"
};

/// Takes events as they happen, in the thread that captures; must not block.
using CaptureEventSink = std::function<void(const CaptureEvent&)>;

}  // namespace alidade
