// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "camera/measurement.h"

namespace alidade {

/// Readings close in time, in order of time.
struct ReadingBatch {
  Timestamp time{};  ///< the middle between the first and the last one's
  std::vector<LineReading> readings;
};

/// Cuts a stream of readings into batches: what lies less than a span of time after its first reading, or at the same
/// time.
class ReadingBatches {
 public:
  explicit ReadingBatches(RecordingClock::duration span) : span_(span) {}

  /// Takes the next reading; the batch before it where it begins another.
  std::optional<ReadingBatch> add(const LineReading& reading);

  /// What is left; empty where nothing is.
  std::optional<ReadingBatch> finish();

 private:
  RecordingClock::duration span_;
  std::vector<LineReading> readings_;
};

}  // namespace alidade
