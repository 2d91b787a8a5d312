// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "camera/measurement.h"
#include "camera/receiver.h"
#include "core/time.h"
#include "uav/flight/flight_path.h"

// What a flight is estimated with: one state for the target and the receivers that watch it.
namespace alidade {

/// Where what stands in the state: the target's (p, v, a); of each receiver how it is turned from its given pose about
/// its own x and y axes (rad), and what its clock wants added (s).
struct FlightLayout {
  int receivers = 0;
  int size() const { return 9 + 3 * receivers; }
  static int turn_at(int receiver) { return 9 + 3 * receiver; }
  static int clock_at(int receiver) { return 11 + 3 * receiver; }
};

/// How far each receiver's directions and clock may be off, from its stated covariances.
struct ReceiverDrift {
  double turn_rad = 0.0;      ///< standard deviation of each coordinate, at any time
  double clock_s = 0.0;       ///< of the offset when the flight begins
  double clock_walk_s = 0.0;  ///< by how much the offset walks off, s per square root of a second
  Eigen::Matrix3d R_world_receiver = Eigen::Matrix3d::Identity();
};

std::vector<ReceiverDrift> receiver_drifts(std::span<const Receiver> receivers, Timestamp begin,
                                           const FlightPathOptions& options);

/// From one step to the next: x' = F x + noise of covariance Q.
struct FlightTransition {
  Eigen::MatrixXd F, Q;
};
FlightTransition flight_transition(std::span<const ReceiverDrift> drifts, const FlightPathOptions& options);

/// Covariance of the state at the first step, before any bearing.
Eigen::MatrixXd flight_prior(std::span<const ReceiverDrift> drifts, const FlightPathOptions& options);

/// What all clocks share: no bearing tells it, since a path flown a little later looks the same. Their mean, each
/// weighed by what is known of it half-way through the flight, stands, and is as uncertain as `sigma_s`.
struct CommonTime {
  Eigen::VectorXd weights;  ///< of the state; their product with it is 0
  double sigma_s = 0.0;
};
CommonTime common_time_of(std::span<const ReceiverDrift> drifts, double duration_s);

/// A bearing as the smoother takes it.
struct FlightBearing {
  Bearing bearing;
  int receiver = 0;    ///< its place among the receivers, not its id
  double share = 1.0;  ///< of the information of a bearing that errs by itself
};

/// The bearings of one step as a quadratic cost of the state: information · x + gradient = 0 at its least.
struct FlightSystem {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;  ///< at the state 0
};

/// `about`: the state at `time` about which the bearings are taken as linear. Those that are off there by more than
/// `loss_sigmas` count less (Cauchy); with `slack` turns that are still to be found do not count as being off.
struct FlightLinearisation {
  Eigen::VectorXd about;
  Timestamp time{};
  double loss_sigmas = 3.0;
  bool slack = false;
};
FlightSystem flight_system(std::span<const FlightBearing> bearings, std::span<const ReceiverDrift> drifts,
                           const FlightLinearisation& at);

}  // namespace alidade
