// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "calib/cameras/view_selection.h"
#include "calib/rigs/rig_calibration.h"

namespace alidade {

/// Films of unsynchronised cameras as calibrate_rig wants them: views of common moments. Each camera chooses moments
/// by select_views; the others' corners at that moment are interpolated (BoardFilm::at, sigma_px included). `frame` of
/// a view is the moment, in the order of time; `name` that of the nearest image; `time_s` is the rig's. Of moments so
/// close that they share images the earlier camera's stays. `offsets_s`, one per camera, give the rig's times; a
/// different number of them, or views whose times do not increase, throw std::invalid_argument.
std::vector<RigCameraViews> synchronise(std::span<const RigCameraViews> films, std::span<const double> offsets_s,
                                        const ViewSelectionOptions& options = {});

}  // namespace alidade
