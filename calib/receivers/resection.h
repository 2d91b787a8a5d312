// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "calib/receivers/known_track.h"
#include "calib/receivers/receiver_parameters.h"

namespace alidade {

struct ResectionOptions {
  double search_s = 1.0;       ///< the clock's offset is looked for this far before and after the given one
  double sweep_step_s = 0.25;  ///< of the coarse sweep: at 6 m/s and 60 m, 1.4° of error at most
  int sweep_readings = 60;     ///< as many, evenly taken, are enough to tell a right offset from a wrong one
  bool keep_pose = false;      ///< starts from the given pose and clock: no sweep
  bool find_place = true;      ///< false: it stands, and so with the next ones
  bool find_turn = true;
  bool find_rate = true;
  bool find_readout = true;
  bool find_focal = false;   ///< a scale of both focal lengths
  double loss_sigmas = 3.0;  ///< readings farther off count less (Cauchy), in units of the scatter
  double block_s = 10.0;     ///< readings within it are off together: what the covariance is counted by
  int least_readings = 100;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const ResectionOptions& options);

/// A receiver as a known track showed it to be.
struct ResectedReceiver {
  /// Pose, clock (its reference amid the readings), rolling shutter; pose_covariance and the clock's say how far they
  /// may be off; sigma is the scatter of a coordinate.
  Receiver receiver;
  ReceiverChange sigma = ReceiverChange::Zero();  ///< standard deviations of what was found; 0 of what stood
  double focal_scale = 1.0;                       ///< of the given focal lengths
  int readings = 0;                               ///< that the track covers
  double median_px = 0.0;                         ///< of the residuals' lengths
  double wander_px = 0.0;  ///< RMS of a coordinate's mean over a block: what no pose and clock explain
};

/// Pose, clock and rolling shutter of a camera from its readings of a target whose path is known: a sweep over the
/// clock's offset with SQPnP on some readings, refined on all of them by robust least squares. The covariance counts
/// blocks of time, not readings, since neighbouring readings err alike; the pose's includes what is left unexplained
/// (wander_px) as a turn about x and y. Empty where the track covers too few of the readings, or no pose explains them.
/// Throws std::invalid_argument for a receiver without a camera and readings of another one.
/// Sources: Terzakis and Lourakis 2020 (SQPnP); Liang and Zeger 1986 (covariance by blocks).
std::optional<ResectedReceiver> resect_receiver(const Receiver& given, std::span<const ReceiverReading> readings,
                                                const KnownTrack& track, const ResectionOptions& options = {});

}  // namespace alidade
