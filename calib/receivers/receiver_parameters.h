// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "calib/receivers/known_track.h"
#include "camera/receiver.h"

namespace alidade {

/// What a calibration may change of a camera that watches the sky, as changes from where it started: the right
/// perturbation of its pose (translation m, rotation rad), the clock's offset (s) and rate (s/s), the rolling shutter
/// (s), and the logarithm of the focal lengths.
inline constexpr int kReceiverParameters = 10;
enum ReceiverParameter { kTranslation = 0, kRotation = 3, kClockOffset = 6, kClockRate = 7, kReadout = 8, kFocal = 9 };
using ReceiverChange = Eigen::Matrix<double, kReceiverParameters, 1>;

/// The receiver with the change made.
Receiver changed(Receiver receiver, const ReceiverChange& change);

/// When the row of a reading was exposed by the common clock, s; `J_change` is its derivative.
struct SightTime {
  double t_s = 0.0;
  ReceiverChange J_change = ReceiverChange::Zero();
};
SightTime sight_time(const Receiver& receiver, const ReceiverChange& change, const ReceiverReading& reading);

/// Where a changed receiver sees a point at its sight time, less where it read it, px.
struct SightResidual {
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 3> J_position = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix<double, 2, kReceiverParameters> J_change =
      Eigen::Matrix<double, 2, kReceiverParameters>::Zero();  ///< the way by which the point moves in time included
};

/// Empty where the point is not in front of the camera. Throws std::invalid_argument for a receiver without a camera.
std::optional<SightResidual> sight_residual(const Receiver& receiver, const ReceiverChange& change,
                                            const ReceiverReading& reading, const TrackPoint& point);

}  // namespace alidade
