// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "datasets/flight_recording.h"
#include "evaluation/flight_score.h"
#include "uav/flight/flight_path.h"

namespace alidade {

/// The half of a recorded flight on which nothing was fitted, and receivers as the other half tells them.
struct JudgedFlight {
  std::vector<Receiver> given;            ///< poses and clocks of the file, covariances by resection on the first half
  std::vector<Receiver> found;            ///< resected on the first half, focal lengths too
  std::vector<double> focal_scales;       ///< of those, by which the published focal lengths are to be multiplied
  std::vector<ReceiverReading> readings;  ///< of the second half
  std::vector<TimedPosition> first_half;  ///< the truth up to where it was used
  std::vector<TimedPosition> epochs;      ///< the truth of the second half
  std::vector<bool> is_jump;              ///< of each epoch: its neighbours contradict it (track_jumps)
};

/// Throws InputError where the recording's first half does not tell a receiver's pose.
JudgedFlight judged_flight(const FlightRecording& recording, const std::string& folder);

/// What was answered at each epoch; empty where nothing.
using FlightAnswers = std::vector<std::optional<PositionPair>>;

/// Of a path, at the epochs at which three receivers or more saw the target.
FlightAnswers answers_of(const FlightPath& path, const JudgedFlight& flight);

/// By the bearing of each receiver that is nearest to the epoch (0.1 s at most), of three receivers or more.
FlightAnswers static_answers(const std::vector<Bearing>& bearings, const JudgedFlight& flight);

/// The answers at the epochs at which `others` has some too.
FlightAnswers where_both(const FlightAnswers& answers, const FlightAnswers& others);

/// How many of the epochs are answered, and how well: all, and those at which the truth does not jump.
struct JudgedAnswers {
  double share = 0.0;
  FlightScore all, without_jumps;
};
JudgedAnswers judge(const FlightAnswers& answers, const JudgedFlight& flight);

/// Receivers whose clocks stand as they are.
std::vector<Receiver> with_sure_clocks(std::vector<Receiver> receivers);

}  // namespace alidade
