// SPDX-License-Identifier: Apache-2.0
#include "marker1d/body_readings.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "geometry/rotation.h"

namespace alidade {
namespace {

const BodyMarker& marker_of(const RigidBody& body, int id) {
  const auto found =
      std::find_if(body.markers.begin(), body.markers.end(), [id](const BodyMarker& m) { return m.id == id; });
  if (found == body.markers.end()) {
    throw std::invalid_argument(fmt::format("body '{}' has no marker {}", body.name, id));
  }
  return *found;
}

}  // namespace

DetectorArray::DetectorArray(std::span<const LineDetector> detectors) {
  for (const LineDetector& d : detectors) {
    const bool is_new = entries_.emplace(d.id, Entry{d, (d.T_world_station * d.T_station_detector).inverse()}).second;
    if (!is_new) throw std::invalid_argument(fmt::format("two detectors have the id {}", d.id));
  }
}

const DetectorArray::Entry& DetectorArray::at(int id) const {
  const auto found = entries_.find(id);
  if (found == entries_.end()) throw std::invalid_argument(fmt::format("there is no detector {}", id));
  return found->second;
}

BodyReadings::BodyReadings(const DetectorArray& detectors, const RigidBody& body, std::span<const LineReading> readings,
                           double variance_factor) {
  for (const LineReading& r : readings) {
    const DetectorArray::Entry& entry = detectors.at(r.detector);
    const double sigma = r.sigma > 0 ? r.sigma : entry.detector.sigma;
    sightings_.push_back(
        {&entry, marker_of(body, r.marker).p_body, r.time, r.value, 1.0 / (sigma * std::sqrt(variance_factor))});
    is_instant_ = is_instant_ && r.time == readings.front().time;
  }
  const auto n = static_cast<Eigen::Index>(readings.size());
  J_.setZero(18, n);
  residual_.setZero(n);
  chi2_.setZero(n);
}

void BodyReadings::linearise(const MotionState& state) {
  state_ = state;
  is_instant_ = is_instant_ && (sightings_.empty() || sightings_.front().time == state.time);
  for (std::size_t i = 0; i < sightings_.size(); ++i) linearise(sightings_[i], static_cast<Eigen::Index>(i));
}

void BodyReadings::linearise(const Sighting& s, Eigen::Index i) {
  const double dt = to_seconds(s.time - state_.time);
  const Eigen::Matrix3d& R_world_body = state_.T_world_body.linear();
  const Eigen::Vector3d turn = dt * state_.omega_body + 0.5 * dt * dt * state_.alpha_body;
  const Eigen::Matrix3d turned = is_instant_ ? Eigen::Matrix3d::Identity() : exp_so3(turn);
  const Eigen::Vector3d p_then = turned * s.p_body;  // in the axes that the body has at the state's time
  const Eigen::Vector3d p_world =
      R_world_body * p_then + state_.T_world_body.translation() + dt * (state_.v_world + 0.5 * dt * state_.a_world);
  const auto reading = project(s.detector->detector.model, s.detector->T_detector_world * p_world);
  auto J = J_.col(i);
  if (!reading) {
    J.setZero();
    residual_(i) = 0.0;
    chi2_(i) = std::numeric_limits<double>::infinity();
    return;
  }
  const Eigen::Vector3d g_world =
      s.per_sigma * (reading->J_value_point * s.detector->T_detector_world.linear()).transpose();
  const Eigen::Vector3d g_body = R_world_body.transpose() * g_world;
  residual_(i) = s.per_sigma * residual(s.detector->detector.model, s.value, reading->value);
  chi2_(i) = residual_(i) * residual_(i);
  J.head<3>() = g_body;
  J.segment<3>(3) = p_then.cross(g_body);
  if (is_instant_) return;
  const Eigen::Vector3d by_turn = right_jacobian_so3(turn).transpose() * s.p_body.cross(turned.transpose() * g_body);
  J.segment<3>(6) = dt * g_world;
  J.segment<3>(9) = dt * by_turn;
  J.segment<3>(12) = 0.5 * dt * dt * g_world;
  J.segment<3>(15) = 0.5 * dt * dt * by_turn;
}

Eigen::ArrayXd BodyReadings::predicted_variance(const Matrix18d& covariance) const {
  if (is_instant_) {
    const auto J = J_.topRows<6>();
    return (covariance.topLeftCorner<6, 6>() * J).cwiseProduct(J).colwise().sum().transpose();
  }
  return (covariance * J_).cwiseProduct(J_).colwise().sum().transpose();
}

MotionLikelihood BodyReadings::weighted_sum(const Eigen::ArrayXd& weight) const {
  MotionLikelihood sum;
  sum.at = state_;
  if (is_instant_) {
    const Eigen::Matrix<double, 6, Eigen::Dynamic> weighted = J_.topRows<6>() * weight.matrix().asDiagonal();
    sum.information.topLeftCorner<6, 6>() = weighted * J_.topRows<6>().transpose();
    sum.gradient.head<6>() = weighted * residual_;
    return sum;
  }
  const Eigen::Matrix<double, 18, Eigen::Dynamic> weighted = J_ * weight.matrix().asDiagonal();
  sum.information = weighted * J_.transpose();
  sum.gradient = weighted * residual_;
  return sum;
}

MotionLikelihood BodyReadings::weighted_sum(const Eigen::ArrayXd& weight, const Eigen::MatrixXd& bends) const {
  MotionLikelihood sum = weighted_sum(weight);
  const Eigen::MatrixXd weighted = weight.matrix().asDiagonal() * bends;
  // (I + ½ B Bᵀ)⁻¹ = I - B (2 I + Bᵀ B)⁻¹ Bᵀ
  const Eigen::MatrixXd inner =
      2.0 * Eigen::MatrixXd::Identity(bends.cols(), bends.cols()) + weighted.transpose() * bends;
  const Eigen::Matrix<double, 18, Eigen::Dynamic> along = J_ * weighted;
  const Eigen::LDLT<Eigen::MatrixXd> factor(inner);
  sum.information -= along * factor.solve(along.transpose());
  sum.gradient -= along * factor.solve(weighted.transpose() * residual_);
  return sum;
}

}  // namespace alidade
