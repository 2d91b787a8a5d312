// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/event_row.h"

#include <fstream>

#include <fmt/format.h>

#include "capture/recording/recording_names.h"
#include "core/errors.h"
#include "io/text_lines.h"

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

// Whether the camera may count from anew on after such an event.
bool is_restart(CaptureEventKind kind) {
  return kind == CaptureEventKind::Opened || kind == CaptureEventKind::Streaming || kind == CaptureEventKind::Restarted;
}

void add_row(EventRows& rows, const std::string& text, int line) {
  const std::size_t first = text.find(','), second = text.find(',', first + 1), third = text.find(',', second + 1);
  if (third == std::string::npos) throw InputError(rows.path, line, "has too few cells", "");
  parse_integer(rows.path, line, std::string_view(text).substr(0, first));
  const std::string name = text.substr(first + 1, second - first - 1);
  const auto kind = parse_capture_event_kind(name);
  if (!kind) throw InputError(rows.path, line, fmt::format("there is no event '{}'", name), "");
  const auto frame = parse_integer(rows.path, line, std::string_view(text).substr(second + 1, third - second - 1));
  if (is_restart(*kind)) rows.restarts.insert(frame);
  ++rows.count;
}

}  // namespace

EventRows read_event_rows(const std::filesystem::path& folder) {
  EventRows rows;
  rows.path = find_recorded(folder, kEventsName);
  std::ifstream file(rows.path, std::ios::binary);
  if (!file) throw InputError(rows.path, 0, "cannot be read", "it belongs to every recording");
  std::string text;
  for (int line = 1; std::getline(file, text) && !file.eof(); ++line) {
    if (line > 1) add_row(rows, text, line);
    if (line == 1 && text + "\n" != event_row_header())
      throw InputError(rows.path, 1, "is not the header of events", "");
    rows.end += static_cast<std::int64_t>(text.size()) + 1;
  }
  return rows;
}

std::string event_row_header() {
  return "host_time_ns,kind,frame,source,detail\n";
}

std::string format_event_row(const CaptureEvent& event) {
  return fmt::format("{},{},{},{},{}\n", event.time.time_since_epoch().count(), name_of(event.kind), event.frame,
                     quoted(event.source), quoted(event.detail));
}

}  // namespace alidade
