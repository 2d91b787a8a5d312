// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "view/scene.h"

class vtkRenderer;

namespace alidade {

/// Puts the scene's points, paths, pyramids and surfaces on a stage, moved by -origin (OpenGL computes in floats), with
/// points and lines `enlargement` times as thick as the scene says. Whatever stood there before is removed.
/// Throws std::invalid_argument for a surface whose parts do not fit each other.
void fill_stage(vtkRenderer& stage, const Scene& scene, const Eigen::Vector3d& origin, double enlargement);

}  // namespace alidade
