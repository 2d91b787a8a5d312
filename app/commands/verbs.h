// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "app/command.h"

namespace alidade {

/// Every verb of the program, in the order of --help. A new verb: app/commands/NAME.cpp with its NAME_verb(), declared
/// here and listed in verbs.cpp.
std::vector<Verb> all_verbs();

Verb devices_verb();
Verb record_verb();
Verb track_camera_verb();
Verb track_body_verb();
Verb track_targets_verb();
Verb calibrate_board_verb();
Verb calibrate_camera_verb();
Verb guide_verb();
Verb calibrate_stereo_verb();
Verb calibrate_rig_verb();
Verb calibrate_detectors_verb();
Verb calibrate_receivers_verb();
Verb map_verb();
Verb repair_verb();
Verb verify_verb();
Verb undistort_verb();
Verb convert_verb();
Verb simulate_camera_verb();
Verb simulate_body_verb();
Verb simulate_targets_verb();
Verb simulate_board_verb();
Verb experiment_camera_verb();
Verb experiment_body_verb();
Verb experiment_targets_verb();
Verb experiment_calibration_verb();
Verb evaluate_verb();
Verb view_verb();

}  // namespace alidade
