// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "camera/detector_rig.h"

namespace alidade {

/// The line detectors of a file, whichever form it has: our YAML (io/detector_file.h), a detectors.json of laser sweeps
/// (below), or a folder that holds detectors.yaml or detectors.json. Throws InputError.
DetectorRig read_detectors(const std::filesystem::path& path);

/// Reads the base stations of a laser-sweep recording, as exported for the data set marker1d: a list `detectors`, each
/// with `id`, `station`, `sweep` (0, 1), `kind`, `pose_logged` (`origin`, and `rotation`, whose columns are the
/// station's axes in the world) and `factory_calibration`. `system` tells the model: "Lighthouse 1" is Lighthouse1
/// (kind "focal-line ..."), "Lighthouse 2" is Lighthouse2Full (kind "tilted-plane ...") in stations whose x looks
/// forward; curve and ogee count as zero where they are not given. A file with `device` in its place (libsurvive's) has
/// stations in that model's own frame, and all terms. A `focal_line` has to agree with the pose. Readings are taken to
/// be good to 0.1 mrad, libsurvive's, of a hand-held device, to 0.3 mrad. Other keys are passed over. Throws
/// InputError, with the line where there is one, for what is missing or contradicts itself.
DetectorRig read_laser_sweep_rig(const std::filesystem::path& path);

}  // namespace alidade
