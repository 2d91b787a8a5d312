// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "capture/image_names.h"
#include "core/errors.h"
#include "datasets/dataset.h"
#include "io/camera_file.h"
#include "io/image_files.h"
#include "io/natural_order.h"
#include "io/pose_files.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

// The files NAME.jpg.camera of a folder, in natural order.
std::vector<fs::path> list_camera_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const fs::path& path = entry.path();
    if (path.extension() == ".camera" && has_image_extension(path.stem())) files.push_back(path);
  }
  std::sort(files.begin(), files.end(),
            [](const fs::path& a, const fs::path& b) { return natural_less(a.native(), b.native()); });
  return files;
}

fs::path find_image(const fs::path& folder, const fs::path& camera_file) {
  const fs::path name = camera_file.stem();
  for (const fs::path& place : {camera_file.parent_path(), folder, folder / "images", folder / "urd"}) {
    if (fs::exists(place / name)) return place / name;
  }
  throw InputError(camera_file, 0, "its image '" + name.string() + "' is missing", "");
}

}  // namespace

std::optional<Dataset> open_strecha(const fs::path& folder) {
  std::vector<fs::path> files = list_camera_files(folder);
  if (files.empty()) files = list_camera_files(folder / "gt_dense_cameras");
  if (files.empty()) return std::nullopt;
  Dataset dataset{.kind = "strecha", .folder = folder};
  for (const fs::path& file : files) {
    const Camera camera = read_camera(file);
    if (dataset.frames.empty()) dataset.camera = camera;
    if (dataset.camera && *dataset.camera != camera) dataset.camera.reset();
    const Timestamp time(from_seconds(static_cast<double>(dataset.frames.size())));
    const Eigen::Isometry3d T_world_camera = read_strecha_pose(file);
    dataset.frames.push_back({time, find_image(folder, file), std::nullopt, T_world_camera});
    dataset.truth.push_back({time, T_world_camera, std::nullopt});
  }
  return dataset;
}

}  // namespace alidade
