// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/run_context.h"
#include "capture/capture_event.h"

namespace alidade {

/// "v4l2:/dev/video0: stalled before frame 17: no frame for 133 ms".
std::string describe(const CaptureEvent& event);

/// Whether a user who watches wants to know at once: a camera that is lost or back, not each dropped frame.
bool is_news(CaptureEventKind kind);

/// Warns the user of the news among the events. `context` must outlive the sink.
CaptureEventSink warn_of_news(const RunContext& context);

}  // namespace alidade
