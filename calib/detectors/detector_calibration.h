// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "calib/detectors/body_motion.h"
#include "camera/detector_rig.h"
#include "camera/measurement.h"
#include "core/progress.h"
#include "geometry/positions.h"
#include "geometry/rigid_body.h"
#include "geometry/trajectory.h"

namespace alidade {

struct DetectorCalibrationOptions {
  double knot_interval_s = 0.02;  ///< of the estimated motion; every reading is taken at its own time between two knots
  MotionDensity density;          ///< how abruptly the body moves; a tenth or ten times of it changes little
  double longest_gap_s = 0.3;     ///< beyond it without readings, the motion before says nothing of the one after
  double loss_sigmas = 3.0;       ///< Geman–McClure's scale: a reading far beyond it counts for nothing
  bool hold_detectors = false;    ///< only the motion is estimated, with detectors and body as they are
  std::string held_station;       ///< whose pose stands and gives the world its frame; empty: the first detector's
  SweepTerms term_sigma;          ///< how well the factory terms are known, rad; 0: they stand
  double marker_sigma_m = 0.0;    ///< how well the places of the body's markers are known; 0: they stand
  double body_size_sigma = 1e-4;  ///< how well its size is known (a part of it), which alone gives the rig its scale
  int max_iterations = 60;        ///< ten to fifty are usual
};

/// Throws std::invalid_argument naming the field, its value and its bound.
void validate(const DetectorCalibrationOptions& options);

/// Where a point of the body was, in a frame of its own: motion capture.
struct MotionReference {
  std::vector<TimedPosition> positions;
  double sigma_m = 2e-3;  ///< of each coordinate, its clock's error included
};

/// How far the readings of one detector, or of one marker, are from the estimate, in units of their standard deviation.
struct ReadingStatistics {
  int count = 0;
  int inlier_count = 0;        ///< within loss_sigmas
  double median_sigmas = 0.0;  ///< of the absolute residuals
  double rms_sigmas = 0.0;     ///< of the inliers' residuals

  double inlier_share() const { return count > 0 ? static_cast<double>(inlier_count) / count : 0.0; }
};

enum class CalibrationOutcome {
  Refined,
  TooFewReadings,  ///< fewer than 24 in all, or than 24 of a station
  NoStart,         ///< no pose of the body explains the first readings
  Undetermined,    ///< the body moves too little or is too small, or the stations do not see it at the same times
  Stopped,         ///< by the user, before the stations were moved
};

/// What else a calibration goes by, and who watches it.
struct CalibrationContext {
  const MotionReference* reference = nullptr;
  ProgressSink progress;  ///< told of each iteration; the total is the most there may be
  std::stop_token stop;   ///< ends the work after the iteration at hand, with what it has
};

struct DetectorCalibration {
  CalibrationOutcome outcome = CalibrationOutcome::Refined;
  DetectorRig rig;    ///< with the covariances of the stations that moved, given the held one
  RigidBody body;     ///< its markers where marker_sigma_m lets them move
  Trajectory motion;  ///< T_world_body at the knots, in order of time
  std::map<int, ReadingStatistics> by_detector, by_marker;  ///< by their ids
  /// The reference's frame and point, where one was given.
  Eigen::Isometry3d T_reference_world = Eigen::Isometry3d::Identity();
  Eigen::Vector3d p_body_reference = Eigen::Vector3d::Zero();
  int iterations = 0;
  bool is_converged = true;  ///< false: ended by max_iterations or the stop before the cost had settled
};

/// Finds where the stations of `detectors` stand from readings of a moving body of known size: a robust bundle over the
/// poses of all stations but one, the body's motion (cubic between knots, white-noise acceleration), and as options say
/// factory terms and markers; with a reference, where a point of the body was at times. Starts from the given poses,
/// which may be off by some degrees; readings of unknown detectors and markers are passed over, wrong ids are borne (a
/// third of all). Readings in order of time. With an outcome other than Refined the rig is as it was given.
/// Deterministic. Throws std::invalid_argument for options out of bounds, no detectors, no markers, or a held station
/// that is none of the detectors'.
DetectorCalibration calibrate_detectors(std::span<const LineDetector> detectors, const RigidBody& body,
                                        std::span<const LineReading> readings,
                                        const DetectorCalibrationOptions& options = {},
                                        const CalibrationContext& context = {});

}  // namespace alidade
