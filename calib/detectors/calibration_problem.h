// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/detectors/bordered_system.h"
#include "calib/detectors/detector_calibration.h"
#include "calib/detectors/motion_start.h"

namespace alidade {

/// All that is estimated.
struct CalibrationState {
  DetectorScene scene;
  std::vector<MotionKnot> knots;
  Eigen::Isometry3d T_reference_world = Eigen::Isometry3d::Identity();
  Eigen::Vector3d p_body_reference = Eigen::Vector3d::Zero();
};

/// The least-squares problem of calibrate_detectors: the readings and the reference between their knots, the motion's
/// and all other priors, and which columns of the border belong to which parameter.
class CalibrationProblem {
 public:
  /// `start` gives the priors' means. Readings are in order of time.
  CalibrationProblem(CalibrationState start, std::vector<PlacedReading> readings,
                     const DetectorCalibrationOptions& options, const MotionReference* reference);

  const std::vector<double>& knot_times() const { return times_; }
  const std::vector<PlacedReading>& readings() const { return readings_; }
  Eigen::Index border_size() const { return border_size_; }
  /// First of six columns of a station, -1 where it is held.
  Eigen::Index station_column(const std::string& station) const;
  /// First of nine columns of the reference (transform, point), -1 without.
  Eigen::Index reference_column() const { return reference_column_; }

  /// Half the robust cost at `state`, readings with the loss scale `loss_sigmas`; adds the normal equations to `system`
  /// where one is given.
  double evaluate(const CalibrationState& state, double loss_sigmas, BorderedSystem* system) const;

  /// `state` changed by a solution.
  CalibrationState moved(const CalibrationState& state, const BorderedSolution& step) const;

  /// Residuals of the readings in units of their sigma; NaN where the detector does not see its marker.
  std::vector<double> residuals(const CalibrationState& state) const;

  /// The pose at a moment between the knots; empty outside them and in a gap of the readings.
  std::optional<Eigen::Isometry3d> pose_at(const CalibrationState& state, double time_s) const;

 private:
  struct Place {
    std::size_t knot = 0;
    double fraction = 0.0;
  };
  struct Term {  // a factory term that moves
    std::size_t detector = 0;
    double SweepTerms::*term = nullptr;
    double sigma = 0.0;
  };

  void lay_knots();
  void lay_border();
  Place place(double time_s) const;
  // Each gives its share of the cost, and adds to the system where there is one.
  double add_reading(const CalibrationState& state, std::size_t index, double loss, BorderedSystem* system) const;
  double add_reference(const CalibrationState& state, BorderedSystem* system) const;
  double add_motion(const CalibrationState& state, BorderedSystem* system) const;
  double add_priors(const CalibrationState& state, BorderedSystem* system) const;
  double add_body_size(const CalibrationState& state, BorderedSystem* system) const;
  std::vector<std::pair<Eigen::Index, double>> border_of(const LineDetector& detector, const PlacedReading& reading,
                                                         const Eigen::Vector3d& p_world,
                                                         const Eigen::RowVector3d& J) const;

  CalibrationState start_;
  std::vector<PlacedReading> readings_;
  DetectorCalibrationOptions options_;
  MotionReference reference_;
  std::vector<double> times_;
  std::vector<bool> linked_;  // knot i + 1 follows knot i
  std::vector<Place> places_, reference_places_;
  std::vector<std::pair<std::string, Eigen::Index>> stations_;  // that move
  std::vector<Eigen::Index> station_of_detector_;               // columns
  std::vector<Term> terms_;
  Eigen::Index term_column_ = 0, marker_column_ = -1, reference_column_ = -1, border_size_ = 0;
};

/// The factory terms of a laser sweep; null for other models.
SweepTerms* sweep_terms(LineModel& model);

}  // namespace alidade
