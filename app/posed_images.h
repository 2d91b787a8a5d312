// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "app/camera_source.h"
#include "geometry/trajectory.h"
#include "tracking/posed_map.h"

namespace alidade {

/// Whether any frame of the data set has a depth image.
bool has_depth(const Dataset& dataset);

/// A frame with its pose and motion by `poses`, interpolated over gaps of at most 0.1 s, and its depth. Empty where its
/// pose is not known, and, in a data set with depth, where the frame has none. Throws InputError for a depth image that
/// cannot be read.
std::optional<PosedImage> posed_image(const CameraSource& source, const ImageFrame& frame, const Trajectory& poses);

}  // namespace alidade
