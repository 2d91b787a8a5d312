// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/body_motion.h"
#include "camera/detector_rig.h"
#include "camera/measurement.h"
#include "geometry/rigid_body.h"
#include "geometry/trajectory.h"

namespace alidade {

struct DetectorCalibrationOptions {
  double knot_interval_s = 0.02;  ///< of the estimated motion; a reading is taken at its own time between two knots
  MotionDensity density;          ///< how abruptly the body moves
  double longest_gap_s = 0.3;     ///< beyond it without readings the motion before says nothing of the one after
  double loss_sigmas = 3.0;       ///< Geman–McClure's scale: a reading far beyond it counts for nothing
  bool hold_stations = false;     ///< only the motion is estimated, with the detectors as they are
  std::string held_station;       ///< whose pose stands and gives the world its frame; empty: the first detector's
  double station_sigma_m = 0.0;   ///< how well the given positions of the stations are known; 0: not at all
  double station_sigma_rad = 0.0;
  SweepTerms term_sigma;        ///< how well factory terms are known, rad; 0: exactly
  double marker_sigma_m = 0.0;  ///< how well the body's markers are known, about their mean; 0: exactly
  int max_iterations = 60;
};

/// Where a point of the body was, in a frame of its own, at a clock's time that may be off.
struct ReferencePosition {
  Timestamp time{};
  Eigen::Vector3d p_reference = Eigen::Vector3d::Zero();  ///< m
};
struct MotionReference {
  std::vector<ReferencePosition> positions;
  double sigma_m = 2e-3;  ///< of each coordinate
};

/// What the readings of one detector, or of one marker, are off by from the estimate.
struct ReadingStatistics {
  int count = 0;
  int inlier_count = 0;  ///< within loss_sigmas
  double median = 0.0;   ///< of the absolute residuals, in the readings' unit
  double rms = 0.0;      ///< of the inliers' residuals
};

enum class CalibrationOutcome {
  Refined,
  TooFewReadings,  ///< of a station, or in all
  NoStart,         ///< no pose of the body explains the first readings
  Undetermined,    ///< the body moves too little, or the stations do not see it at the same times
};

struct DetectorCalibration {
  CalibrationOutcome outcome = CalibrationOutcome::Refined;
  DetectorRig rig;  ///< with the covariances of the stations that moved, given the held one
  RigidBody body;
  Trajectory motion;  ///< T_world_body at the knots that have readings beside them
  std::map<int, ReadingStatistics> by_detector, by_marker;
  /// Of the reference, where one was given: T_reference_world, and the reference's point in the body.
  Eigen::Isometry3d T_reference_world = Eigen::Isometry3d::Identity();
  Eigen::Vector3d p_body_reference = Eigen::Vector3d::Zero();
  int iterations = 0;
  double cost = 0;
};

DetectorCalibration calibrate_detectors(std::span<const LineDetector> detectors, const RigidBody& body,
                                        std::span<const LineReading> readings,
                                        const DetectorCalibrationOptions& options = {},
                                        const MotionReference* reference = nullptr);

}  // namespace alidade
