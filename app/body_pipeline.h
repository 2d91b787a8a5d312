// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "app/body_record.h"
#include "app/options_yaml.h"
#include "marker1d/body_smoother.h"
#include "marker1d/body_tracker.h"
#include "marker1d/paper_tracker.h"
#include "marker1d/reading_batches.h"

namespace alidade {

enum class BodyMethod { Ours, Paper };

struct BodyTrackOptions {
  BodyMethod method = BodyMethod::Ours;
  double batch_s = 0.004;  ///< readings within this time make one pose: 250 a second, as the paper's detectors
  double lag_s = 0.5;      ///< what comes so much later still improves a pose; 0: nothing does
  BodyTrackerOptions ours;
  PaperTrackerOptions paper;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const BodyTrackOptions& options);

/// Binds them to flags and keys of --config. `options` must outlive `fields`.
void bind(OptionFields& fields, BodyTrackOptions& options);

/// What the options' method tells of a body.
PoseDetail detail_of(const BodyTrackOptions& options);

/// One line of words for the report: how poses are found.
std::string describe(const BodyTrackOptions& options);

/// From readings in order of time to a record of poses: cuts batches, tells readings apart by body, tracks each body,
/// smooths with a fixed lag. In memory that does not grow.
class BodyPipeline {
 public:
  /// Called for each batch of each body as soon as it is tracked; an empty function is allowed.
  using LiveSink = std::function<void(const std::string& body, const BodyEstimate& estimate)>;

  /// Refers to the record. Throws std::invalid_argument as the trackers do.
  BodyPipeline(std::span<const LineDetector> detectors, std::span<const RigidBody> bodies,
               const BodyTrackOptions& options, BodyRecord& record, LiveSink live);
  BodyPipeline(const BodyPipeline&) = delete;  // the trackers refer to its detectors
  BodyPipeline& operator=(const BodyPipeline&) = delete;

  /// Readings of the bodies' markers (else std::invalid_argument), in order of time. Whether a batch was tracked.
  bool add(const LineReading& reading);

  /// The last batch, and what smoothing has kept back. Once, and last.
  void finish();

 private:
  struct Follower {
    RigidBody body;
    std::variant<BodyTracker, PaperTracker> tracker;
    std::optional<BodySmoother> smoother;
    std::vector<LineReading> readings;  // of this body in the batch
  };

  void track(const ReadingBatch& batch);
  BodyEstimate estimate(BodyTracker& tracker, const Follower& follower, Timestamp time) const;
  BodyEstimate estimate(PaperTracker& tracker, const Follower& follower, Timestamp time) const;

  DetectorArray array_;
  std::vector<LineDetector> detectors_;
  BodyTrackOptions options_;
  BodyRecord& record_;
  LiveSink live_;
  ReadingBatches batches_;
  std::deque<Follower> followers_;
  std::map<int, std::size_t> body_of_marker_;
};

}  // namespace alidade
