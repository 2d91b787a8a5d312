// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/rig_calibration_run.h"
#include "app/run_context.h"

namespace alidade {

/// Finds how the cameras' clocks stand to the first one's from their films of the moving board (`run.images` with all
/// views, and names), and replaces the views by those of common moments. Throws InputError naming the source that has
/// no times, whose times do not increase, that cannot be calibrated alone, or whose motion does not match the first
/// one's. Stopped meanwhile it leaves `run.clocks` empty.
void synchronise_cameras(RigCalibrationRun& run, const CameraCalibrationOptions& options, const RunContext& context);

}  // namespace alidade
