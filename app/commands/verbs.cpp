// SPDX-License-Identifier: Apache-2.0
#include "app/commands/verbs.h"

namespace alidade {

std::vector<Verb> all_verbs() {
  return {devices_verb(),
          record_verb(),
          track_camera_verb(),
          track_body_verb(),
          track_targets_verb(),
          calibrate_board_verb(),
          guide_verb(),
          calibrate_camera_verb(),
          calibrate_stereo_verb(),
          calibrate_rig_verb(),
          calibrate_detectors_verb(),
          calibrate_receivers_verb(),
          map_verb(),
          repair_verb(),
          verify_verb(),
          undistort_verb(),
          convert_verb(),
          simulate_camera_verb(),
          simulate_body_verb(),
          simulate_targets_verb(),
          simulate_board_verb(),
          experiment_camera_verb(),
          experiment_body_verb(),
          experiment_targets_verb(),
          experiment_calibration_verb(),
          evaluate_verb(),
          view_verb()};
}

}  // namespace alidade
