// SPDX-License-Identifier: Apache-2.0
#include "marker1d/reading_batches.h"

#include <utility>

namespace alidade {

std::optional<ReadingBatch> ReadingBatches::add(const LineReading& reading) {
  std::optional<ReadingBatch> before;
  const auto age = readings_.empty() ? RecordingClock::duration(0) : reading.time - readings_.front().time;
  if (age > RecordingClock::duration(0) && age >= span_) before = finish();
  readings_.push_back(reading);
  return before;
}

std::optional<ReadingBatch> ReadingBatches::finish() {
  if (readings_.empty()) return std::nullopt;
  const Timestamp first = readings_.front().time, last = readings_.back().time;
  return ReadingBatch{first + (last - first) / 2, std::exchange(readings_, {})};
}

}  // namespace alidade
