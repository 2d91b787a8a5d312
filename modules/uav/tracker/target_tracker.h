// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "uav/tracker/track_book.h"

namespace alidade {

enum class TargetStatus {
  Tentative,  ///< may be a chance of false bearings yet
  Confirmed,
  Coasting,  ///< confirmed, but nobody has seen it for one and a half periods
};

/// What is known of one target at one moment.
struct TargetEstimate {
  int id = 0;  ///< never given to another target
  TargetState state;
  TargetStatus status = TargetStatus::Tentative;
  int sightings = 0;                  ///< bearings that were taken for it
  double temperature_mean_k = 0.0;    ///< of what receivers read of it
  double temperature_spread_k = 0.0;  ///< standard deviation of a reading
  int temperature_readings = 0;       ///< 0: no receiver reads temperatures
};

/// Follows any number of targets through bearings as they come in, by any number of receivers. Bearings that arrive
/// late, by no more than lag_s, are put where they belong: what is answered does not depend on the order of arrival.
/// Needs no memory beyond that of lag_s and window_periods of bearings and of the tracks that live.
/// Source: UAV paper page, "Where we go past it", 3.
class TargetTracker {
 public:
  explicit TargetTracker(const TargetTrackerOptions& options = {});

  /// Takes a bearing in, and the time on to its own; false where it came too late and was left out. Throws
  /// std::invalid_argument for a direction that is not of unit length, for a covariance that is not positive definite,
  /// and for values that are not finite.
  bool add(const Bearing& bearing);

  /// Nothing older than lag_s before `time` is coming any more.
  void advance(Timestamp time);

  /// The newest moment that was heard of; Timestamp{} before any.
  Timestamp now() const { return now_; }

  /// What is known at `time` by the bearings up to it: all targets, in order of their ids. At times that are more than
  /// lag_s ago: by the bearings up to then, as if nothing was seen since. Ids of targets that were found within the
  /// last lag_s may change when a late bearing comes in.
  std::vector<TargetEstimate> estimates_at(Timestamp time);

  /// Bearings that are kept: of the last lags, and those that may yet start a track.
  std::size_t remembered() const { return bearings_.size() + checkpoints_.back().book.unclaimed.size(); }

  /// Bearings that came too late.
  std::size_t left_out() const { return left_out_; }

 private:
  // The book after all scans that begin before or with this one.
  struct Checkpoint {
    TrackBook book;
    Timestamp begin{};  // of its last scan
    int receiver = 0;   // "
    Timestamp end{};    // bearings up to here may belong to one of its scans
  };

  static bool is_in(const Checkpoint& checkpoint, const BearingScan& scan);
  Checkpoint after(Checkpoint checkpoint, const BearingScan& scan) const;
  void catch_up();
  void settle();
  TrackBook book_at(Timestamp time) const;

  TargetTrackerOptions options_;
  std::vector<Bearing> bearings_;       // since the first checkpoint, in order
  std::deque<Checkpoint> checkpoints_;  // at least one; the first is older than lag_s
  Timestamp now_{}, settled_{};
  bool has_begun_ = false;
  std::size_t left_out_ = 0;
};

}  // namespace alidade
