// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/body_record.h"
#include "view/scene.h"

namespace alidade {

/// What a body track looks like: stations and detectors (pyramids along their line of sight), the path of each body
/// with ellipsoids of its position's covariance, and of each body's fullest batch the markers, lines of sight and the
/// planes of one marker. World z is up.
Scene scene_of(const BodyRun& run);

}  // namespace alidade
