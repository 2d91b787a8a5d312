// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "marker1d/body_start.h"
#include "marker1d/body_update.h"
#include "marker1d/motion_learner.h"

namespace alidade {

struct BodyTrackerOptions {
  BodyUpdateOptions update;
  BodyStartOptions start;
  double start_window_s = 0.05;         ///< readings that a start may be made of
  double most_position_sigma_m = 0.01;  ///< a body that is less sure along any axis is not answered
  double most_rotation_sigma_rad = 0.05;
  double lost_factor = 10.0;        ///< and beyond this many times as much it is given up, to be started anew
  bool learn_reading_noise = true;  ///< correct the detectors' sigma by the residuals
  bool learn_motion = true;         ///< the motion's noise from the motion so far, by innovation likelihood
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const BodyTrackerOptions& options);

enum class BodyStatus {
  Lost,       ///< not known well enough to be answered
  Ambiguous,  ///< one of the candidates
  Tracked,
};

/// What is known of a body after a batch of readings.
struct BodyEstimate {
  Timestamp time{};
  BodyStatus status = BodyStatus::Lost;
  MotionState state;                    ///< of the most probable candidate; means nothing where lost
  std::vector<MotionState> candidates;  ///< all of them where ambiguous, most probable first
  int determined = 0;                   ///< directions of the pose, 0 to 6, that this batch determines by itself
  std::vector<bool> is_inlier;          ///< one per reading of the batch; none where lost
  int inlier_count = 0;
  double chi2 = 0.0;               ///< of the inliers
  bool is_start = false;           ///< nothing from before was used
  std::optional<MotionStep> step;  ///< where tracked: what a smoother needs
};

/// Follows one body through batches of readings: predicts, updates, notices when it is lost, starts again. Where
/// readings leave several poses possible, all are carried along until one survives.
class BodyTracker {
 public:
  /// Refers to the detectors.
  BodyTracker(const DetectorArray& detectors, RigidBody body, const BodyTrackerOptions& options = {});

  /// Batches come in order of time; `time` is the moment to answer for, at most a few readings' spacing from them.
  BodyEstimate track(Timestamp time, std::span<const LineReading> readings);

  /// The factor on the detectors' variances that the residuals bear out.
  double variance_factor() const { return variance_factor_; }

 private:
  struct Hypothesis {
    MotionState state;
    double log_evidence = 0.0;
  };

  // What became of a hypothesis.
  struct Branch {
    BodyUpdate update;
    double log_evidence;
    bool of_the_most_probable;
  };

  std::optional<BodyEstimate> follow(Timestamp time, std::span<const LineReading> readings);
  Branch update_hypotheses(Timestamp time, std::span<const LineReading> readings);  // returns the most probable
  std::vector<Branch> branches(const BodyReadings& readings, Timestamp time,
                               std::span<const Eigen::Isometry3d> others) const;
  bool is_misfit(const BodyUpdate& update) const;
  BodyEstimate start(Timestamp time);
  BodyEstimate answer(Timestamp time) const;
  bool is_sure(const MotionState& state, double factor) const;
  void learn(const BodyUpdate& update);

  const DetectorArray& detectors_;
  RigidBody body_;
  BodyTrackerOptions options_;
  std::vector<Hypothesis> hypotheses_;  // most probable first; empty: lost
  std::deque<LineReading> recent_;      // to start from
  MotionLearner learner_;
  double variance_factor_ = 1.0;
  double factor_degrees_ = 0.0;  // degrees of freedom that it rests on
  double share_ = 1.0;           // of the readings that fit, in the long run
  int misfits_ = 0;              // batches in a row that mostly do not fit
};

}  // namespace alidade
