// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>

#include "capture/image_names.h"
#include "core/errors.h"
#include "datasets/dataset.h"
#include "datasets/pose_matrix.h"
#include "io/text_lines.h"

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

// Where the fusion lost track, the set's authors wrote "-1.#IND", inf or nan.
bool says_lost(const std::vector<TextLine>& lines) {
  for (const TextLine& line : lines) {
    for (const char* word : {"#IN", "#QNAN", "inf", "nan", "NaN", "INF"}) {
      if (line.text.find(word) != std::string::npos) return true;
    }
  }
  return false;
}

std::optional<Eigen::Isometry3d> read_pose(const fs::path& path) {
  const std::vector<TextLine> lines = read_lines(path);
  if (lines.size() != 4) throw InputError(path, 0, "holds no pose", "4 rows of a 4x4 matrix are wanted");
  if (says_lost(lines)) return std::nullopt;
  Eigen::Matrix4d T;
  for (int i = 0; i < 4; ++i) {
    const TextLine& line = lines[static_cast<std::size_t>(i)];
    const std::vector<double> row = parse_numbers(path, line);
    if (row.size() != 4) throw InputError(path, line.number, "a row of a 4x4 matrix is wanted", "");
    T.row(i) = Eigen::Map<const Eigen::RowVector4d>(row.data());
  }
  return pose_from(path, lines.front().number, T.topLeftCorner<3, 3>(), T.topRightCorner<3, 1>());
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
    const auto T_world_camera = fs::exists(pose_file(image)) ? read_pose(pose_file(image)) : std::nullopt;
    dataset.frames.push_back({time, image, std::nullopt, T_world_camera});
    if (T_world_camera) dataset.truth.push_back({time, *T_world_camera, std::nullopt});
  }
  dataset.camera = find_camera(folder, "camera.txt", dataset.frames.front().image);
  return dataset;
}

}  // namespace alidade
