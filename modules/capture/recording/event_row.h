// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include "capture/capture_event.h"

namespace alidade {

/// The first line of events.csv, and a line for an event, with their ends. Times are on the host's monotonic clock;
/// `frame` counts as source_index in frames.csv does.
std::string event_row_header();
std::string format_event_row(const CaptureEvent& event);

/// What events.csv of a recording holds.
struct EventRows {
  std::filesystem::path path;       ///< events.csv or events.csv.part
  std::int64_t count = 0;           ///< rows, without a last one that was not written to its end
  std::int64_t end = 0;             ///< of the last row, bytes
  std::set<std::int64_t> restarts;  ///< source indices of the frames before which the camera began anew
};

/// Throws InputError where there is none, or naming path and line where a row cannot be.
EventRows read_event_rows(const std::filesystem::path& folder);

}  // namespace alidade
