// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "capture/capture_event.h"

namespace alidade {

/// The first line of events.csv, and a line for an event, with their ends. Times are on the host's monotonic clock;
/// `frame` counts as source_index in frames.csv does.
std::string event_row_header();
std::string format_event_row(const CaptureEvent& event);

}  // namespace alidade
