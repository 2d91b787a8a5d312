// SPDX-License-Identifier: Apache-2.0
#include "uav/flight/flight_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geometry/rotation.h"
#include "geometry/tangent.h"

namespace alidade {
namespace {

using Row = Eigen::Matrix<double, 2, Eigen::Dynamic>;

constexpr double kLeastRange_m = 1.0;        // nearer, a start that is far off would count without bound
constexpr double kLeastClockSigma_s = 1e-7;  // a clock that stands, so that covariances stay positive definite
constexpr double kPriorPosition_m = 100.0;

// Turns by errors of the place at the usual range added to those of the axes across the line of sight.
double turn_of(const Receiver& receiver, const FlightPathOptions& options) {
  if (!receiver.pose_covariance) return options.turn_rad;
  const Matrix6d& P = *receiver.pose_covariance;
  return std::sqrt(0.5 * (P(3, 3) + P(4, 4)) + 0.5 * (P(0, 0) + P(1, 1)) / (options.range_m * options.range_m));
}

// The bearing's error across its direction, and its derivatives: error + J x' for a change x' of the state.
struct LinearBearing {
  Eigen::Vector2d error;
  Row J;
};

LinearBearing linearise(const FlightBearing& f, const ReceiverDrift& drift, const FlightLinearisation& at) {
  const Bearing& b = f.bearing;
  const Eigen::VectorXd& x = at.about;
  const int turn = FlightLayout::turn_at(f.receiver), clock = FlightLayout::clock_at(f.receiver);
  const double dt = to_seconds(b.time - at.time) + x[clock];
  const Eigen::Vector3d p = x.head<3>() + dt * x.segment<3>(3) + 0.5 * dt * dt * x.segment<3>(6);
  const Eigen::Vector3d v = x.segment<3>(3) + dt * x.segment<3>(6);
  const Eigen::Vector3d line = p - b.origin_world;
  const double range = std::max(line.norm(), kLeastRange_m);
  const Eigen::Vector3d u = line / range;
  const Eigen::Matrix<double, 3, 2> basis = tangent_basis(b.direction_world);
  const Eigen::Matrix<double, 2, 3> J_p = basis.transpose() * (Eigen::Matrix3d::Identity() - u * u.transpose()) / range;
  const Eigen::Matrix2d J_turn =
      basis.transpose() * skew(b.direction_world) * drift.R_world_receiver.leftCols<2>();  // the true one is turned on
  LinearBearing linear{basis.transpose() * u + J_turn * x.segment<2>(turn), Row::Zero(2, x.size())};
  linear.J.leftCols<3>() = J_p;
  linear.J.middleCols<3>(3) = dt * J_p;
  linear.J.middleCols<3>(6) = 0.5 * dt * dt * J_p;
  linear.J.middleCols<2>(turn) = J_turn;
  linear.J.col(clock) = J_p * v;
  return linear;
}

}  // namespace

std::vector<ReceiverDrift> receiver_drifts(std::span<const Receiver> receivers, Timestamp begin,
                                           const FlightPathOptions& options) {
  std::vector<ReceiverDrift> drifts;
  for (const Receiver& receiver : receivers) {
    const Eigen::Vector2d J(1.0, to_seconds(begin - receiver.clock.reference));
    ReceiverDrift drift;
    drift.turn_rad = turn_of(receiver, options);
    if (!(drift.turn_rad > 0.0)) throw std::invalid_argument("receiver_drifts: a pose covariance without turns");
    drift.clock_s = std::sqrt(J.dot(receiver.clock.covariance * J)) + kLeastClockSigma_s;
    drift.clock_walk_s = std::sqrt(receiver.clock.covariance(1, 1) * options.clock_history_s);
    drift.R_world_receiver = receiver.T_world_receiver.linear();
    drifts.push_back(drift);
  }
  return drifts;
}

FlightTransition flight_transition(std::span<const ReceiverDrift> drifts, const FlightPathOptions& options) {
  const int size = FlightLayout{static_cast<int>(drifts.size())}.size();
  const double h = options.step_s, tau = options.acceleration_time_s, fade = std::exp(-h / tau);
  // Of the white noise that drives the acceleration, so that its variance stays what it is.
  const double density = options.acceleration_m_s2 * options.acceleration_m_s2 * (1.0 - fade * fade) / h;
  FlightTransition t{Eigen::MatrixXd::Identity(size, size), Eigen::MatrixXd::Zero(size, size)};
  const Eigen::Matrix3d noise{{h * h * h * h * h / 20, h * h * h * h / 8, h * h * h / 6},
                              {h * h * h * h / 8, h * h * h / 3, h * h / 2},
                              {h * h * h / 6, h * h / 2, h}};
  for (int axis = 0; axis < 3; ++axis) {
    t.F(axis, 3 + axis) = h;
    t.F(axis, 6 + axis) = tau * (h - tau * (1.0 - fade));
    t.F(3 + axis, 6 + axis) = tau * (1.0 - fade);
    t.F(6 + axis, 6 + axis) = fade;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) t.Q(3 * i + axis, 3 * j + axis) = density * noise(i, j);
    }
  }
  const double keep = std::exp(-h / options.drift_time_s);
  for (int k = 0; k < static_cast<int>(drifts.size()); ++k) {
    const ReceiverDrift& drift = drifts[static_cast<std::size_t>(k)];
    const int turn = FlightLayout::turn_at(k), clock = FlightLayout::clock_at(k);
    t.F.block<2, 2>(turn, turn) *= keep;
    t.Q.block<2, 2>(turn, turn).diagonal().setConstant(drift.turn_rad * drift.turn_rad * (1.0 - keep * keep));
    t.Q(clock, clock) = drift.clock_walk_s * drift.clock_walk_s * h;
  }
  return t;
}

Eigen::MatrixXd flight_prior(std::span<const ReceiverDrift> drifts, const FlightPathOptions& options) {
  const int size = FlightLayout{static_cast<int>(drifts.size())}.size();
  Eigen::VectorXd sigma(size);
  sigma.head<3>().setConstant(kPriorPosition_m);
  sigma.segment<3>(3).setConstant(options.speed_m_s);
  sigma.segment<3>(6).setConstant(options.acceleration_m_s2);
  for (int k = 0; k < static_cast<int>(drifts.size()); ++k) {
    sigma.segment<2>(FlightLayout::turn_at(k)).setConstant(drifts[static_cast<std::size_t>(k)].turn_rad);
    sigma[FlightLayout::clock_at(k)] = drifts[static_cast<std::size_t>(k)].clock_s;
  }
  return sigma.cwiseAbs2().asDiagonal();
}

CommonTime common_time_of(std::span<const ReceiverDrift> drifts, double duration_s) {
  CommonTime common{Eigen::VectorXd::Zero(FlightLayout{static_cast<int>(drifts.size())}.size()), 0.0};
  for (int k = 0; k < static_cast<int>(drifts.size()); ++k) {
    const ReceiverDrift& drift = drifts[static_cast<std::size_t>(k)];
    const double walked = drift.clock_walk_s * drift.clock_walk_s * 0.5 * duration_s;
    common.weights[FlightLayout::clock_at(k)] = 1.0 / (drift.clock_s * drift.clock_s + walked);
  }
  const double sum = common.weights.sum();
  common.weights /= sum;
  common.sigma_s = 1.0 / std::sqrt(sum);
  return common;
}

FlightSystem flight_system(std::span<const FlightBearing> bearings, std::span<const ReceiverDrift> drifts,
                           const FlightLinearisation& at) {
  const Eigen::Index size = at.about.size();
  FlightSystem system{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  for (const FlightBearing& f : bearings) {
    const ReceiverDrift& drift = drifts[static_cast<std::size_t>(f.receiver)];
    const LinearBearing linear = linearise(f, drift, at);
    const Eigen::Matrix2d noise = f.bearing.covariance / f.share;
    Eigen::Matrix2d judged = noise;
    if (at.slack) judged.diagonal().array() += drift.turn_rad * drift.turn_rad;
    const double off2 = linear.error.dot(judged.inverse() * linear.error) / (at.loss_sigmas * at.loss_sigmas);
    const Eigen::Matrix2d weight = noise.inverse() / (1.0 + off2);
    const Row weighted = weight * linear.J;
    system.information.noalias() += linear.J.transpose() * weighted;
    system.gradient.noalias() += weighted.transpose() * (linear.error - linear.J * at.about);
  }
  return system;
}

}  // namespace alidade
