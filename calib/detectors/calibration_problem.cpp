// SPDX-License-Identifier: Apache-2.0
#include "calib/detectors/calibration_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/pose.h"
#include "geometry/rotation.h"

namespace alidade {

using Eigen::Isometry3d;
using Eigen::Vector3d;

SweepTerms* sweep_terms(LineModel& model) {
  return std::visit(
      [](auto& m) -> SweepTerms* {
        if constexpr (requires { m.terms; }) return &m.terms;
        return nullptr;
      },
      model);
}

CalibrationProblem::CalibrationProblem(CalibrationState start, std::vector<PlacedReading> readings,
                                       const DetectorCalibrationOptions& options, const MotionReference* reference)
    : start_(std::move(start)), readings_(std::move(readings)), options_(options) {
  if (reference) reference_ = *reference;
  lay_knots();
  lay_border();
  for (const PlacedReading& reading : readings_) places_.push_back(place(reading.time_s));
  std::vector<TimedPosition> between;
  for (const TimedPosition& position : reference_.positions) {
    const double t = to_seconds(position.time.time_since_epoch());
    if (!(t >= times_.front() && t < times_.back())) continue;
    const Place p = place(t);
    if (!linked_[p.knot]) continue;
    reference_places_.push_back(p);
    between.push_back(position);
  }
  reference_.positions = std::move(between);
}

// Knots at equal steps from the first reading on; after a gap they start anew.
void CalibrationProblem::lay_knots() {
  const double h = options_.knot_interval_s;
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const double t = readings_[i].time_s;
    if (i == 0 || t > times_.back() + options_.longest_gap_s) {
      if (!times_.empty()) linked_.push_back(false);
      times_.push_back(t);
    }
    while (times_.back() <= t) {
      linked_.push_back(true);
      times_.push_back(times_.back() + h);
    }
  }
}

void CalibrationProblem::lay_border() {
  const auto& detectors = start_.scene.detectors;
  const std::string held = options_.held_station.empty() ? detectors.front().station : options_.held_station;
  for (const LineDetector& detector : detectors) {
    if (options_.hold_detectors || detector.station == held || station_column(detector.station) >= 0) {
      continue;
    }
    stations_.emplace_back(detector.station, border_size_);
    border_size_ += 6;
  }
  for (const LineDetector& detector : detectors) station_of_detector_.push_back(station_column(detector.station));
  term_column_ = border_size_;
  constexpr double SweepTerms::*kTerms[] = {&SweepTerms::phase,    &SweepTerms::tilt,     &SweepTerms::curve,
                                            &SweepTerms::gibmag,   &SweepTerms::gibphase, &SweepTerms::ogeemag,
                                            &SweepTerms::ogeephase};
  for (std::size_t i = 0; i < detectors.size(); ++i) {
    LineModel model = detectors[i].model;
    if (options_.hold_detectors || !sweep_terms(model)) continue;
    for (const auto term : kTerms) {
      if (options_.term_sigma.*term > 0) terms_.push_back({i, term, options_.term_sigma.*term});
    }
  }
  border_size_ += static_cast<Eigen::Index>(terms_.size());
  if (options_.marker_sigma_m > 0 && !options_.hold_detectors) {
    marker_column_ = border_size_;
    border_size_ += 3 * static_cast<Eigen::Index>(start_.scene.markers.size());
  }
  if (!reference_.positions.empty()) {
    reference_column_ = border_size_;
    border_size_ += 9;
  }
}

Eigen::Index CalibrationProblem::station_column(const std::string& station) const {
  for (const auto& [name, column] : stations_) {
    if (name == station) return column;
  }
  return -1;
}

CalibrationProblem::Place CalibrationProblem::place(double time_s) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time_s);
  const auto index = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(after - times_.begin() - 1, 0, static_cast<std::ptrdiff_t>(times_.size()) - 2));
  return {index, (time_s - times_[index]) / options_.knot_interval_s};
}

CalibrationState CalibrationProblem::moved(const CalibrationState& state, const BorderedSolution& step) const {
  CalibrationState result = state;
  for (std::size_t i = 0; i < state.knots.size(); ++i) result.knots[i] = alidade::moved(state.knots[i], step.knots[i]);
  for (std::size_t i = 0; i < state.scene.detectors.size(); ++i) {
    if (station_of_detector_[i] < 0) continue;
    auto& T = result.scene.detectors[i].T_world_station;
    T = T * perturbation(step.border.segment<6>(station_of_detector_[i]));
  }
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    sweep_terms(result.scene.detectors[terms_[i].detector].model)->*terms_[i].term +=
        step.border[term_column_ + static_cast<Eigen::Index>(i)];
  }
  for (std::size_t i = 0; marker_column_ >= 0 && i < state.scene.markers.size(); ++i) {
    result.scene.markers[i] += step.border.segment<3>(marker_column_ + 3 * static_cast<Eigen::Index>(i));
  }
  if (reference_column_ >= 0) {
    result.T_reference_world = state.T_reference_world * perturbation(step.border.segment<6>(reference_column_));
    result.p_body_reference += step.border.segment<3>(reference_column_ + 6);
  }
  return result;
}

std::vector<double> CalibrationProblem::residuals(const CalibrationState& state) const {
  std::vector<double> all;
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const LineDetector& detector = state.scene.detectors[readings_[i].detector];
    const MotionPose pose = interpolate(state.knots[places_[i].knot], state.knots[places_[i].knot + 1],
                                        options_.knot_interval_s, places_[i].fraction);
    const auto projection =
        project(detector, Vector3d(pose.p_world + pose.R_world_body * state.scene.markers[readings_[i].marker]));
    all.push_back(projection ? residual(detector.model, readings_[i].value, projection->value) / readings_[i].sigma
                             : std::numeric_limits<double>::quiet_NaN());
  }
  return all;
}

std::optional<Isometry3d> CalibrationProblem::pose_at(const CalibrationState& state, double time_s) const {
  if (!(time_s >= times_.front() && time_s <= times_.back())) return std::nullopt;
  const Place at = place(time_s);
  if (!linked_[at.knot] && at.fraction > 0) return std::nullopt;
  const MotionPose pose =
      interpolate(state.knots[at.knot], state.knots[at.knot + 1], options_.knot_interval_s, at.fraction);
  Isometry3d T = Isometry3d::Identity();
  T.linear() = pose.R_world_body;
  T.translation() = pose.p_world;
  return T;
}

}  // namespace alidade
