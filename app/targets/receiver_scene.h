// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Geometry>

#include "camera/receiver.h"
#include "view/scene.h"

namespace alidade {

/// Adds receivers with their names to a scene, as pyramids along their line of sight, `size_m` deep.
void add_receivers(std::span<const Receiver> receivers, double size_m, Scene& scene);

/// How large receivers look well among things in `box` (m).
double receiver_size_m(std::span<const Receiver> receivers, Eigen::AlignedBox3d box);

}  // namespace alidade
