// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/pose.h"
#include "geometry/rotation.h"

namespace alidade {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::RowVectorXd;
using Eigen::Vector3d;

// Rows of a linearised residual: of two neighbouring knots and of the border, mostly zeros.
struct SparseRow {
  std::size_t knot = 0;
  Eigen::Matrix<double, 1, 12> before = Eigen::Matrix<double, 1, 12>::Zero(), after = before;
  std::vector<std::pair<Eigen::Index, double>> border;
};

void add_row(const SparseRow& row, double residual, double weight, BorderedSystem& s) {
  const std::size_t k = row.knot;
  s.diagonal[k].noalias() += weight * row.before.transpose() * row.before;
  s.diagonal[k + 1].noalias() += weight * row.after.transpose() * row.after;
  s.coupling[k].noalias() += weight * row.after.transpose() * row.before;
  s.gradient[k].noalias() += weight * residual * row.before.transpose();
  s.gradient[k + 1].noalias() += weight * residual * row.after.transpose();
  for (const auto& [i, a] : row.border) {
    s.border[k].row(i).noalias() += weight * a * row.before;
    s.border[k + 1].row(i).noalias() += weight * a * row.after;
    s.border_gradient[i] += weight * a * residual;
    for (const auto& [j, b] : row.border) s.corner(i, j) += weight * a * b;
  }
}

}  // namespace

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
  std::vector<ReferencePosition> between;
  for (const ReferencePosition& position : reference_.positions) {
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
  const bool all_soft = options_.station_sigma_m > 0;
  for (const LineDetector& detector : detectors) {
    if (options_.hold_stations || (detector.station == held && !all_soft) || station_column(detector.station) >= 0) {
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
    if (options_.hold_stations || !sweep_terms(model)) continue;
    for (const auto term : kTerms) {
      if (options_.term_sigma.*term > 0) terms_.push_back({i, term, options_.term_sigma.*term});
    }
  }
  border_size_ += static_cast<Eigen::Index>(terms_.size());
  if (options_.marker_sigma_m > 0) {
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

double CalibrationProblem::evaluate(const CalibrationState& state, double loss, BorderedSystem* system) const {
  double cost = 0;
  for (std::size_t i = 0; i < readings_.size(); ++i) add_reading(state, i, loss, &cost, system);
  add_reference(state, &cost, system);
  add_motion(state, &cost, system);
  add_priors(state, &cost, system);
  return cost;
}

void CalibrationProblem::add_reading(const CalibrationState& state, std::size_t index, double loss, double* cost,
                                     BorderedSystem* system) const {
  const PlacedReading& reading = readings_[index];
  const Place& at = places_[index];
  const LineDetector& detector = state.scene.detectors[reading.detector];
  const Vector3d& p_body = state.scene.markers[reading.marker];
  const MotionPose pose =
      interpolate(state.knots[at.knot], state.knots[at.knot + 1], options_.knot_interval_s, at.fraction);
  const Vector3d p_world = pose.p_world + pose.R_world_body * p_body;
  const auto projection = project(detector, p_world);
  const double c2 = loss * loss;
  if (!projection) {  // counts as much as what is far off, and pulls nowhere
    *cost += 0.5 * c2;
    return;
  }
  const double r = residual(detector.model, reading.value, projection->value) / reading.sigma;
  *cost += 0.5 * c2 * r * r / (c2 + r * r);
  if (!system) return;
  const double root = c2 / (c2 + r * r);
  const Eigen::RowVector3d J = projection->J_value_point / reading.sigma;
  const Eigen::RowVector3d J_turn = -J * pose.R_world_body * skew(p_body);
  SparseRow row;
  row.knot = at.knot;
  row.before = J * pose.J_before.topRows<3>() + J_turn * pose.J_before.bottomRows<3>();
  row.after = J * pose.J_after.topRows<3>() + J_turn * pose.J_after.bottomRows<3>();
  if (const Eigen::Index column = station_of_detector_[reading.detector]; column >= 0) {
    const Eigen::RowVector3d J_station = -J * detector.T_world_station.linear();
    const Vector3d p_station =
        detector.T_world_station.linear().transpose() * (p_world - detector.T_world_station.translation());
    const Eigen::RowVector3d J_rotation = -J_station * skew(p_station);
    for (int i = 0; i < 3; ++i) row.border.emplace_back(column + i, J_station[i]);
    for (int i = 0; i < 3; ++i) row.border.emplace_back(column + 3 + i, J_rotation[i]);
  }
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (terms_[i].detector != reading.detector) continue;
    constexpr double kStep = 1e-5;
    LineDetector up = detector, down = detector;
    sweep_terms(up.model)->*terms_[i].term += kStep;
    sweep_terms(down.model)->*terms_[i].term -= kStep;
    const auto more = project(up, p_world), less = project(down, p_world);
    if (!more || !less) continue;
    row.border.emplace_back(term_column_ + static_cast<Eigen::Index>(i),
                            (more->value - less->value) / (2 * kStep * reading.sigma));
  }
  if (marker_column_ >= 0) {
    const Eigen::RowVector3d J_marker = J * pose.R_world_body;
    for (int i = 0; i < 3; ++i) {
      row.border.emplace_back(marker_column_ + 3 * static_cast<Eigen::Index>(reading.marker) + i, J_marker[i]);
    }
  }
  add_row(row, r, root * root, *system);
}

void CalibrationProblem::add_reference(const CalibrationState& state, double* cost, BorderedSystem* system) const {
  const Isometry3d& T = state.T_reference_world;
  for (std::size_t n = 0; n < reference_places_.size(); ++n) {
    const Place& at = reference_places_[n];
    const MotionPose pose =
        interpolate(state.knots[at.knot], state.knots[at.knot + 1], options_.knot_interval_s, at.fraction);
    const Vector3d p_world = pose.p_world + pose.R_world_body * state.p_body_reference;
    const Vector3d r = (reference_.positions[n].p_reference - T * p_world) / reference_.sigma_m;
    const double c2 = options_.loss_sigmas * options_.loss_sigmas, r2 = r.squaredNorm();
    *cost += 0.5 * c2 * r2 / (c2 + r2);
    if (!system) continue;
    const double root = c2 / (c2 + r2);
    const Matrix3d J = T.linear() / reference_.sigma_m;
    const Matrix3d J_turn = -J * pose.R_world_body * skew(state.p_body_reference);
    const Matrix3d J_rotation = -J * skew(p_world), J_point = J * pose.R_world_body;
    for (int i = 0; i < 3; ++i) {
      SparseRow row;
      row.knot = at.knot;
      row.before = J.row(i) * pose.J_before.topRows<3>() + J_turn.row(i) * pose.J_before.bottomRows<3>();
      row.after = J.row(i) * pose.J_after.topRows<3>() + J_turn.row(i) * pose.J_after.bottomRows<3>();
      for (int j = 0; j < 3; ++j) row.border.emplace_back(reference_column_ + j, J(i, j));
      for (int j = 0; j < 3; ++j) row.border.emplace_back(reference_column_ + 3 + j, J_rotation(i, j));
      for (int j = 0; j < 3; ++j) row.border.emplace_back(reference_column_ + 6 + j, J_point(i, j));
      add_row(row, r[i], root * root, *system);
    }
  }
}

void CalibrationProblem::add_motion(const CalibrationState& state, double* cost, BorderedSystem* system) const {
  for (std::size_t i = 0; i + 1 < state.knots.size(); ++i) {
    if (!linked_[i]) continue;
    const MotionConstraint c =
        constrain(state.knots[i], state.knots[i + 1], options_.knot_interval_s, options_.density);
    *cost += 0.5 * c.residual.squaredNorm();
    if (!system) continue;
    system->diagonal[i].noalias() += c.J_before.transpose() * c.J_before;
    system->diagonal[i + 1].noalias() += c.J_after.transpose() * c.J_after;
    system->coupling[i].noalias() += c.J_after.transpose() * c.J_before;
    system->gradient[i].noalias() -= c.J_before.transpose() * c.residual;
    system->gradient[i + 1].noalias() -= c.J_after.transpose() * c.residual;
  }
}

void CalibrationProblem::add_priors(const CalibrationState& state, double* cost, BorderedSystem* system) const {
  const auto add = [&](Eigen::Index column, double off, double sigma) {  // `off`: what is still to go to the mean
    *cost += 0.5 * off * off / (sigma * sigma);
    if (!system) return;
    system->corner(column, column) += 1.0 / (sigma * sigma);
    system->border_gradient[column] += off / (sigma * sigma);
  };
  for (const auto& [name, column] : stations_) {
    if (!(options_.station_sigma_m > 0)) break;
    for (std::size_t i = 0; i < start_.scene.detectors.size(); ++i) {
      if (start_.scene.detectors[i].station != name) continue;
      const Vector6d off =
          difference(state.scene.detectors[i].T_world_station, start_.scene.detectors[i].T_world_station);
      for (int k = 0; k < 6; ++k) {
        add(column + k, off[k], k < 3 ? options_.station_sigma_m : options_.station_sigma_rad);
      }
      break;
    }
  }
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    LineModel now = state.scene.detectors[terms_[i].detector].model;
    LineModel then = start_.scene.detectors[terms_[i].detector].model;
    add(term_column_ + static_cast<Eigen::Index>(i),
        sweep_terms(then)->*terms_[i].term - sweep_terms(now)->*terms_[i].term, terms_[i].sigma);
  }
  for (std::size_t i = 0; marker_column_ >= 0 && i < state.scene.markers.size(); ++i) {
    const Vector3d off = start_.scene.markers[i] - state.scene.markers[i];
    for (int k = 0; k < 3; ++k) {
      add(marker_column_ + 3 * static_cast<Eigen::Index>(i) + k, off[k], options_.marker_sigma_m);
    }
  }
  for (int k = 0; reference_column_ >= 0 && k < 9; ++k) {  // only keeps it solvable
    add(reference_column_ + k, k < 6 ? 0.0 : -state.p_body_reference[k - 6], k < 6 ? 100.0 : 0.1);
  }
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

Isometry3d CalibrationProblem::pose_at(const CalibrationState& state, double time_s) const {
  const Place at = place(time_s);
  const MotionPose pose =
      interpolate(state.knots[at.knot], state.knots[at.knot + 1], options_.knot_interval_s, at.fraction);
  Isometry3d T = Isometry3d::Identity();
  T.linear() = pose.R_world_body;
  T.translation() = pose.p_world;
  return T;
}

}  // namespace alidade
