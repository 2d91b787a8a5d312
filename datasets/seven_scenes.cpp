// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "capture/image_names.h"
#include "datasets/dataset.h"
#include "datasets/find_camera.h"
#include "io/pose_files.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

constexpr double kFrameRateHz = 30.0;  // the Kinect's; the data has no times

bool is_colour_image(const fs::path& image) {
  return image.filename().native().starts_with("frame-") && image.stem().extension() == ".color";
}

fs::path pose_file(const fs::path& image) {
  return image.parent_path() / image.stem().replace_extension(".pose.txt");
}

}  // namespace

std::optional<Dataset> open_seven_scenes(const fs::path& folder) {
  std::error_code ignored;
  bool found = false;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    found = found || (is_colour_image(entry.path()) && fs::exists(pose_file(entry.path())));
  }
  if (!found) return std::nullopt;
  Dataset dataset{.kind = "seven-scenes", .folder = folder, .timed = true};
  for (const fs::path& image : list_images(folder)) {
    if (!is_colour_image(image)) continue;
    const std::string number = image.filename().native().substr(6);
    const Timestamp time(from_seconds(std::atoi(number.c_str()) / kFrameRateHz));
    const auto T_world_camera = fs::exists(pose_file(image)) ? read_pose_matrix(pose_file(image)) : std::nullopt;
    dataset.frames.push_back({time, image, std::nullopt, T_world_camera});
    if (T_world_camera) dataset.truth.push_back({time, *T_world_camera, std::nullopt});
  }
  dataset.camera = find_camera(folder, "camera.txt", dataset.frames.front().image);
  return dataset;
}

}  // namespace alidade
