// SPDX-License-Identifier: Apache-2.0
#include "datasets/dataset.h"

#include <fmt/format.h>

#include "capture/file_sources.h"

namespace alidade {

std::optional<Dataset> open_dataset(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  for (const auto read : {open_strecha, open_seven_scenes, open_kitti, open_tum_rgbd}) {
    if (auto dataset = read(folder)) return dataset;
  }
  return std::nullopt;
}

std::unique_ptr<FrameSource> open_frames(const Dataset& dataset) {
  std::vector<TimedImage> images;
  for (const DatasetFrame& frame : dataset.frames) images.push_back({frame.image, frame.time});
  return open_images(
      std::move(images), dataset.timed,
      fmt::format("{} images of kind {} in {}", dataset.frames.size(), dataset.kind, dataset.folder.string()));
}

}  // namespace alidade
