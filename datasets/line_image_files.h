// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "datasets/line_image_scene.h"

namespace alidade {

/// Writes what the scene's detectors record in `rows` exposures as io/line_images.h reads it: lines.yaml and
/// detector_ID.png, the codes with the phases of `signs` (none: unknown). The directory must exist. Throws DeviceError
/// where the file system refuses.
void write_line_images(const LineImageScene& scene, int rows, const std::filesystem::path& directory);

}  // namespace alidade
