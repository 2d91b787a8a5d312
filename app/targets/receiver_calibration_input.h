// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "camera/measurement.h"
#include "camera/receiver.h"
#include "geometry/positions.h"

namespace alidade {

/// What the user named for `calibrate receivers`.
struct ReceiverCalibrationSources {
  std::string receivers;     ///< a file, or a folder that holds observations, too
  std::string observations;  ///< CSV, or a folder; empty: in the folder of the receivers
  std::string
      truth;  ///< where the target was: CSV, TUM, a recorded flight or a result of `simulate targets`; empty: not known
  std::optional<double> start_s;  ///< by the common clock; empty: from the beginning
  std::optional<double> end_s;    ///< not itself; empty: to the end
};

/// The same, read: all that a calibration goes by.
struct ReceiverCalibrationInput {
  ReceiverCalibrationSources sources;
  std::vector<Receiver> receivers;        ///< all, cameras or not
  std::vector<ReceiverReading> readings;  ///< of cameras alone, within the interval, by id, then by time
  std::vector<TimedPosition> truth;       ///< in order of time, four positions or more; empty: not known

  std::vector<Receiver> cameras() const;
};

/// Reads receivers, observations and, where it is known, the path. Throws InputError for what cannot be read, where no
/// receiver is a camera, for no reading in the interval, observations of several targets, and a path that is too short,
/// does not go on in time, or lies in another time than all readings; without a path, for fewer than two cameras that
/// saw anything.
ReceiverCalibrationInput read_calibration_input(const ReceiverCalibrationSources& sources);

}  // namespace alidade
