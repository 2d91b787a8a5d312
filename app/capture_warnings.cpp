// SPDX-License-Identifier: Apache-2.0
#include "app/capture_warnings.h"

#include <fmt/format.h>

namespace alidade {

std::string describe(const CaptureEvent& event) {
  const std::string head = fmt::format("{}: {} before frame {}", event.source, name_of(event.kind), event.frame);
  return event.detail.empty() ? head : head + ": " + event.detail;
}

bool is_news(CaptureEventKind kind) {
  switch (kind) {
    case CaptureEventKind::Stalled:
    case CaptureEventKind::Resumed:
    case CaptureEventKind::Disconnected:
    case CaptureEventKind::InUse:
    case CaptureEventKind::OpenFailed:
    case CaptureEventKind::Restarted:
      return true;
    default:
      return false;
  }
}

CaptureEventSink warn_of_news(const RunContext& context) {
  return [&context, lost = false](const CaptureEvent& event) mutable {
    const bool is_back = event.kind == CaptureEventKind::Streaming || event.kind == CaptureEventKind::Resumed;
    if (is_news(event.kind) || (lost && is_back)) context.warn(describe(event));
    if (is_news(event.kind) || is_back) lost = !is_back;
  };
}

}  // namespace alidade
