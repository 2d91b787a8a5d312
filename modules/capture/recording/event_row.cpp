// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/event_row.h"

#include <fmt/format.h>

namespace alidade {
namespace {

// A cell in quotes; what would break the line becomes a blank.
std::string quoted(const std::string& text) {
  std::string cell = "\"";
  for (const char c : text) {
    if (c == '"') cell += '"';
    cell += c == '\n' || c == '\r' ? ' ' : c;
  }
  return cell + '"';
}

}  // namespace

std::string event_row_header() {
  return "host_time_ns,kind,source,frame,detail\n";
}

std::string format_event_row(const CaptureEvent& event) {
  return fmt::format("{},{},{},{},{}\n", event.time.time_since_epoch().count(), name_of(event.kind),
                     quoted(event.source), event.frame, quoted(event.detail));
}

}  // namespace alidade
