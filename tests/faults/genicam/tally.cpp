// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/genicam/tally.h"

#include <algorithm>

namespace alidade::test {

const LoggedFrame* find_stamped(const std::vector<LoggedFrame>& log, const CaptureStamp& stamp) {
  if (!stamp.device_time) return nullptr;
  const auto wanted = static_cast<std::uint64_t>(stamp.device_time->time_since_epoch().count());
  const auto found = std::lower_bound(log.begin(), log.end(), wanted, [](const LoggedFrame& frame, std::uint64_t time) {
    return frame.device_time < time;
  });
  return found != log.end() && found->device_time == wanted ? &*found : nullptr;
}

Tally tally_of(const std::vector<SeenFrame>& frames, const std::vector<LoggedFrame>& log) {
  const auto is_good = [](const SeenFrame& frame) { return !frame.stamp.is_damaged; };
  const auto first = std::find_if(frames.begin(), frames.end(), is_good);
  const auto last = std::find_if(frames.rbegin(), frames.rend(), is_good);
  if (first == frames.end()) return {};
  const LoggedFrame* const exposed_first = find_stamped(log, first->stamp);
  const LoggedFrame* const exposed_last = find_stamped(log, last->stamp);
  Tally tally;
  if (exposed_first && exposed_last) {
    tally.exposed = static_cast<int>(exposed_last - exposed_first) + 1;
    tally.never_sent = static_cast<int>(
        std::count_if(exposed_first, exposed_last, [](const LoggedFrame& frame) { return frame.is_dropped; }));
  }
  for (auto frame = first; frame != last.base(); ++frame) {
    if (frame != first) tally.counted += static_cast<int>(frame->stamp.dropped_before);
    if (is_good(*frame)) {
      const LoggedFrame* const exposed = find_stamped(log, frame->stamp);
      const bool is_right = frame->is_exact && exposed && !exposed->is_dropped && exposed->picture == frame->picture;
      ++tally.good;
      tally.wrong += is_right ? 0 : 1;
    } else {
      ++tally.damaged;
      tally.nameless += frame->stamp.sequence ? 0 : 1;
    }
  }
  return tally;
}

}  // namespace alidade::test
