// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/receivers/clock_blocks.h"
#include "calib/receivers/known_track.h"
#include "camera/receiver.h"

namespace alidade {

enum class ReceiverFault {
  SwappedPlaces,  ///< with `other`: each stands where the other is said to stand
  WrongPlace,     ///< size: how far from where it is said to stand, m
  WrongFocal,     ///< size: by what the given focal lengths are to be multiplied
  UnevenClock,    ///< size: how far it runs from a straight line, s: dropped frames, a variable frame rate
  Unexplained,    ///< no pose, clock or focal length explains its readings
};

struct ReceiverFinding {
  ReceiverFault fault = ReceiverFault::WrongPlace;
  int receiver = 0;
  int other = -1;
  double size = 0.0;
  double sigma = 0.0;  ///< standard deviation of size
};

/// "receiver 3: focal lengths are to be multiplied by 0.970".
std::string describe(const ReceiverFinding& finding);

struct ReceiverCheckOptions {
  double least_place_m = 1.0;    ///< places off by less are no fault: consumer cameras' poses age by decimetres
  double least_focal = 0.01;     ///< focal lengths off by a smaller share are no fault; poses make up for as much
  double least_uneven_s = 0.05;  ///< clocks off by less at worst are no fault: one and a half frames at 30 Hz
  double sigmas = 5.0;           ///< and what is found stands out by so many standard deviations
  double search_s = 1.0;         ///< a clock's offset is looked for this far from the given one
  ClockBlockOptions blocks{};
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const ReceiverCheckOptions& options);

/// What is wrong with receivers as they are given, judged by their readings of a target whose track is known: each is
/// resected anew and compared with what is said of it. Of several explanations the one that leaves the least is told.
/// Those with fewer than a hundred readings on the track are passed over. In order of the receivers.
std::vector<ReceiverFinding> check_receivers(std::span<const Receiver> receivers,
                                             std::span<const ReceiverReading> readings, const KnownTrack& track,
                                             const ReceiverCheckOptions& options = {});

}  // namespace alidade
