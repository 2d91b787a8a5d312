// SPDX-License-Identifier: Apache-2.0
#include "capture/capture_event.h"

#include <array>
#include <utility>

namespace alidade {
namespace {

constexpr std::array<std::pair<CaptureEventKind, std::string_view>, 12> kNames{{
    {CaptureEventKind::Opened, "opened"},
    {CaptureEventKind::Streaming, "streaming"},
    {CaptureEventKind::Stalled, "stalled"},
    {CaptureEventKind::Resumed, "resumed"},
    {CaptureEventKind::Disconnected, "disconnected"},
    {CaptureEventKind::InUse, "in use"},
    {CaptureEventKind::OpenFailed, "open failed"},
    {CaptureEventKind::Restarted, "restarted"},
    {CaptureEventKind::FramesDropped, "frames dropped"},
    {CaptureEventKind::FrameDamaged, "frame damaged"},
    {CaptureEventKind::FramesDiscarded, "frames discarded"},
    {CaptureEventKind::Closed, "closed"},
}};

}  // namespace

std::string_view name_of(CaptureEventKind kind) {
  for (const auto& [known, name] : kNames) {
    if (known == kind) return name;
  }
  return "";
}

std::optional<CaptureEventKind> parse_capture_event_kind(std::string_view name) {
  for (const auto& [kind, known] : kNames) {
    if (known == name) return kind;
  }
  return std::nullopt;
}

}  // namespace alidade
