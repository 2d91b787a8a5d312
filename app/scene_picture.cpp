// SPDX-License-Identifier: Apache-2.0
#include "app/scene_picture.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "view/renderer.h"

namespace alidade {

std::optional<cv::Mat> draw_scene(const Scene& scene, const ViewAngles& angles, const std::string& what,
                                  std::vector<std::string>& warnings) {
  const cv::Size size(1500, 1000);
  try {
    return render(scene, frame_scene(scene, angles, static_cast<double>(size.width) / size.height), size);
  } catch (const DeviceError& error) {
    warnings.push_back(fmt::format("no picture of {}: {}", what, error.what()));
    return std::nullopt;
  }
}

}  // namespace alidade
