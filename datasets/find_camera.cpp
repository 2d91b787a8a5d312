// SPDX-License-Identifier: Apache-2.0
#include "datasets/find_camera.h"

#include "io/camera_file.h"
#include "io/image_files.h"

namespace alidade {

std::optional<Camera> find_camera(const std::filesystem::path& folder, const char* name,
                                  const std::filesystem::path& image) {
  for (const auto& place : {folder / name, folder / ".." / name}) {
    if (!std::filesystem::exists(place)) continue;
    const cv::Mat pixels = read_image(image);
    return read_camera(place, ImageSize{pixels.cols, pixels.rows});
  }
  return std::nullopt;
}

}  // namespace alidade
