// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "calib/detectors/calibration_problem.h"
#include "geometry/pose.h"
#include "geometry/rotation.h"

// The residuals of CalibrationProblem and their derivatives.
namespace alidade {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::RowVector3d;
using Eigen::Vector3d;

constexpr double kReferenceArm = 0.1;  // m; how far from the body's origin the reference may be
constexpr double kTermStep = 1e-5;     // rad; readings are almost linear in the factory terms

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

void append(std::vector<std::pair<Eigen::Index, double>>& border, Eigen::Index column, const RowVector3d& J) {
  for (int i = 0; i < 3; ++i) border.emplace_back(column + i, J[i]);
}

// How the distances of the markers from their mean have to grow for all to grow by one part of themselves: the
// gradient of the body's size by its markers, stacked.
Eigen::VectorXd size_gradient(const std::vector<Vector3d>& markers) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : markers) mean += p / static_cast<double>(markers.size());
  Eigen::VectorXd arms(3 * static_cast<Eigen::Index>(markers.size()));
  for (std::size_t i = 0; i < markers.size(); ++i)
    arms.segment<3>(3 * static_cast<Eigen::Index>(i)) = markers[i] - mean;
  return arms / std::max(arms.squaredNorm(), 1e-12);
}

}  // namespace

double CalibrationProblem::evaluate(const CalibrationState& state, double loss, BorderedSystem* system) const {
  double cost = 0;
  for (std::size_t i = 0; i < readings_.size(); ++i) cost += add_reading(state, i, loss, system);
  return cost + add_reference(state, system) + add_motion(state, system) + add_priors(state, system);
}

double CalibrationProblem::add_reading(const CalibrationState& state, std::size_t index, double loss,
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
  if (!projection) return 0.5 * c2;  // counts as much as what is far off, and pulls nowhere
  const double r = residual(detector.model, reading.value, projection->value) / reading.sigma;
  const double root = c2 / (c2 + r * r);
  if (system) {
    const RowVector3d J = projection->J_value_point / reading.sigma;
    const RowVector3d J_turn = -J * pose.R_world_body * skew(p_body);
    SparseRow row;
    row.knot = at.knot;
    row.before = J * pose.J_before.topRows<3>() + J_turn * pose.J_before.bottomRows<3>();
    row.after = J * pose.J_after.topRows<3>() + J_turn * pose.J_after.bottomRows<3>();
    row.border = border_of(detector, reading, p_world, J);
    if (marker_column_ >= 0) {
      append(row.border, marker_column_ + 3 * static_cast<Eigen::Index>(reading.marker), J * pose.R_world_body);
    }
    add_row(row, r, root * root, *system);
  }
  return 0.5 * root * r * r;
}

// What a reading owes to its station's pose and its detector's factory terms; J by the point of the world.
std::vector<std::pair<Eigen::Index, double>> CalibrationProblem::border_of(const LineDetector& detector,
                                                                           const PlacedReading& reading,
                                                                           const Vector3d& p_world,
                                                                           const RowVector3d& J) const {
  std::vector<std::pair<Eigen::Index, double>> border;
  if (const Eigen::Index column = station_of_detector_[reading.detector]; column >= 0) {
    const RowVector3d J_station = -J * detector.T_world_station.linear();
    append(border, column, J_station);
    append(border, column + 3, -J_station * skew(detector.T_world_station.inverse() * p_world));
  }
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    if (terms_[i].detector != reading.detector) continue;
    LineDetector more = detector, less = detector;
    sweep_terms(more.model)->*terms_[i].term += kTermStep;
    sweep_terms(less.model)->*terms_[i].term -= kTermStep;
    const auto up = project(more, p_world), down = project(less, p_world);
    if (!up || !down) continue;
    border.emplace_back(term_column_ + static_cast<Eigen::Index>(i),
                        (up->value - down->value) / (2 * kTermStep * reading.sigma));
  }
  return border;
}

// Cauchy's loss, however far the loss of the readings has come: a reference that is off at first must go on pulling.
double CalibrationProblem::add_reference(const CalibrationState& state, BorderedSystem* system) const {
  const Isometry3d& T = state.T_reference_world;
  constexpr double kScale2 = 5.0 * 5.0;
  double cost = 0;
  for (std::size_t n = 0; n < reference_places_.size(); ++n) {
    const Place& at = reference_places_[n];
    const MotionPose pose =
        interpolate(state.knots[at.knot], state.knots[at.knot + 1], options_.knot_interval_s, at.fraction);
    const Vector3d p_world = pose.p_world + pose.R_world_body * state.p_body_reference;
    const Vector3d r = (reference_.positions[n].p - T * p_world) / reference_.sigma_m;
    cost += 0.5 * kScale2 * std::log1p(r.squaredNorm() / kScale2);
    if (!system) continue;
    const double weight = 1.0 / (1.0 + r.squaredNorm() / kScale2);
    const Matrix3d J = T.linear() / reference_.sigma_m;
    const Matrix3d J_turn = -J * pose.R_world_body * skew(state.p_body_reference);
    const Matrix3d J_rotation = -J * skew(p_world), J_point = J * pose.R_world_body;
    for (int i = 0; i < 3; ++i) {
      SparseRow row;
      row.knot = at.knot;
      row.before = J.row(i) * pose.J_before.topRows<3>() + J_turn.row(i) * pose.J_before.bottomRows<3>();
      row.after = J.row(i) * pose.J_after.topRows<3>() + J_turn.row(i) * pose.J_after.bottomRows<3>();
      append(row.border, reference_column_, J.row(i));
      append(row.border, reference_column_ + 3, J_rotation.row(i));
      append(row.border, reference_column_ + 6, J_point.row(i));
      add_row(row, r[i], weight, *system);
    }
  }
  return cost;
}

double CalibrationProblem::add_motion(const CalibrationState& state, BorderedSystem* system) const {
  double cost = 0;
  if (system) {  // a moment with a few readings only, between two gaps, must not leave the system singular
    Vector12d ignorance;
    ignorance << Vector3d::Constant(10.0), Vector3d::Constant(3.0), Vector3d::Constant(30.0), Vector3d::Constant(30.0);
    for (auto& block : system->diagonal) block.diagonal() += ignorance.array().square().inverse().matrix();
  }
  for (std::size_t i = 0; i + 1 < state.knots.size(); ++i) {
    if (!linked_[i]) continue;
    const MotionConstraint c =
        constrain(state.knots[i], state.knots[i + 1], options_.knot_interval_s, options_.density);
    cost += 0.5 * c.residual.squaredNorm();
    if (!system) continue;
    system->diagonal[i].noalias() += c.J_before.transpose() * c.J_before;
    system->diagonal[i + 1].noalias() += c.J_after.transpose() * c.J_after;
    system->coupling[i].noalias() += c.J_after.transpose() * c.J_before;
    system->gradient[i].noalias() -= c.J_before.transpose() * c.residual;
    system->gradient[i + 1].noalias() -= c.J_after.transpose() * c.residual;
  }
  return cost;
}

double CalibrationProblem::add_priors(const CalibrationState& state, BorderedSystem* system) const {
  double cost = 0;
  const auto add = [&](Eigen::Index column, double off, double sigma) {  // `off`: what is still to go to the mean
    cost += 0.5 * off * off / (sigma * sigma);
    if (!system) return;
    system->corner(column, column) += 1.0 / (sigma * sigma);
    system->border_gradient[column] += off / (sigma * sigma);
  };
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    LineModel now = state.scene.detectors[terms_[i].detector].model;
    LineModel then = start_.scene.detectors[terms_[i].detector].model;
    add(term_column_ + static_cast<Eigen::Index>(i),
        sweep_terms(then)->*terms_[i].term - sweep_terms(now)->*terms_[i].term, terms_[i].sigma);
  }
  for (std::size_t i = 0; marker_column_ >= 0 && i < state.scene.markers.size(); ++i) {
    const Vector3d off = start_.scene.markers[i] - state.scene.markers[i];
    for (int k = 0; k < 3; ++k)
      add(marker_column_ + 3 * static_cast<Eigen::Index>(i) + k, off[k], options_.marker_sigma_m);
  }
  for (int k = 0; reference_column_ >= 0 && k < 3; ++k) {  // without a turn of the body the point is not determined
    add(reference_column_ + 6 + k, -state.p_body_reference[k], kReferenceArm);
  }
  return cost + add_body_size(state, system);
}

// The markers may move, but the body's size, which gives the rig its scale, holds to its own tolerance.
double CalibrationProblem::add_body_size(const CalibrationState& state, BorderedSystem* system) const {
  if (marker_column_ < 0) return 0.0;
  const Eigen::VectorXd J = size_gradient(start_.scene.markers);
  double growth = 0.0;
  for (std::size_t i = 0; i < start_.scene.markers.size(); ++i) {
    growth += J.segment<3>(3 * static_cast<Eigen::Index>(i)).dot(state.scene.markers[i] - start_.scene.markers[i]);
  }
  const double information = 1.0 / (options_.body_size_sigma * options_.body_size_sigma);
  if (system) {
    system->corner.block(marker_column_, marker_column_, J.size(), J.size()) += information * J * J.transpose();
    system->border_gradient.segment(marker_column_, J.size()) -= information * growth * J;
  }
  return 0.5 * information * growth * growth;
}

}  // namespace alidade
