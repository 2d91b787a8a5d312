// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "app/body_files.h"
#include "app/reading_residuals.h"
#include "app/reading_source.h"
#include "app/thinned.h"

namespace alidade {

/// A pose out of many, for plots and pictures.
struct BodySample {
  Timestamp time{};
  BodyStatus status = BodyStatus::Lost;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();  ///< means nothing where lost
  Matrix6d covariance = Matrix6d::Zero();
  std::optional<double> inlier_share;  ///< of the batch's readings; empty where there are none, and at a start
};

/// One batch as the picture shows it.
struct BodySnapshot {
  MotionState state;
  std::vector<LineReading> readings;  ///< those that are explained
};

/// What became of one body.
struct BodyTally {
  static constexpr std::size_t kMostSamples = 4000;

  std::int64_t tracked = 0, ambiguous = 0, lost = 0;  ///< batches
  std::int64_t readings = 0;                          ///< of the body's markers
  std::int64_t explained = 0;                         ///< of these
  double position_sigma_sum_m = 0.0;                  ///< over tracked batches: root of the trace
  double rotation_sigma_sum_rad = 0.0;
  Thinned<BodySample> samples{kMostSamples};
  std::optional<BodySnapshot> fullest;  ///< the tracked batch of the most explained readings, the first of equals

  std::int64_t batches() const { return tracked + ambiguous + lost; }
};

/// A body track as it was run, for those who tell of it.
struct BodyRun {
  PoseDetail detail = PoseDetail::Motion;
  std::vector<LineDetector> detectors;
  std::vector<RigidBody> bodies;
  std::vector<BodyTally> tallies;  ///< one per body
  std::vector<ResidualRow> residuals;
  std::int64_t batches = 0;
  Timestamp first{}, last{};  ///< of the batches
  std::vector<std::string> warnings;

  // What the command adds:
  std::string source;
  std::vector<DetectorSignal> signals;  ///< of line images
  std::string method;                   ///< how poses were found, in words
  double tracking_s = 0;                ///< reading, tracking and writing
  bool interrupted = false;
  std::optional<std::string> fault;  ///< what in the observations ended the run before their end

  /// Whether any body was tracked in any batch.
  bool has_answer() const;
};

/// Takes what trackers say of several bodies, batch by batch, and writes it down as it comes; keeps only statistics and
/// thinned samples, so that memory does not grow with the recording.
class BodyRecord {
 public:
  /// Refers to the directory. Throws std::invalid_argument for no body.
  BodyRecord(const ResultDirectory& directory, std::vector<LineDetector> detectors, std::vector<RigidBody> bodies,
             PoseDetail detail = PoseDetail::Motion);

  /// A batch right after it was tracked: residuals are taken here. Every body is told of every batch, in order of time.
  void observe(std::size_t body, const BodyEstimate& estimate, std::span<const LineReading> readings);

  /// The same batch as it is to be written down: perhaps later, and smoothed. Every observed batch comes once, in
  /// order; else std::invalid_argument.
  void add(std::size_t body, const BodyEstimate& estimate);

  /// The run so far.
  const BodyRun& run() const { return run_; }

  /// Writes residuals.csv and brings all files to their names; the record is not used afterwards.
  BodyRun commit();

 private:
  struct Pending {
    Timestamp time{};
    std::size_t readings = 0;
  };

  const ResultDirectory& directory_;
  DetectorArray detectors_;
  BodyFiles files_;
  ReadingResiduals residuals_;
  std::vector<std::deque<Pending>> pending_;  // per body: observed and not yet added
  BodyRun run_;
};

}  // namespace alidade
