// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "view/scene.h"
#include "view/viewpoint.h"

namespace alidade {

/// A report's picture of a scene. Empty on a machine that cannot draw, with a warning: "no picture of the stations:
/// ..."
std::optional<cv::Mat> draw_scene(const Scene& scene, const ViewAngles& angles, const std::string& what,
                                  std::vector<std::string>& warnings);

}  // namespace alidade
