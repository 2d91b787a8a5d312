// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>
#include <fmt/format.h>

#include "capture/image_names.h"
#include "core/errors.h"
#include "datasets/dataset.h"
#include "io/camera_file.h"
#include "io/image_files.h"
#include "io/text_lines.h"
#include "io/trajectory_file.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

constexpr double kFrameRateHz = 10.0;

/// A folder of images and the projection matrix that is its camera's.
struct ImageFolder {
  fs::path path;
  std::size_t camera = 0;
};

std::optional<ImageFolder> find_images(const fs::path& folder) {
  const std::pair<const char*, std::size_t> names[] = {{"image_l", 0}, {"image_0", 0}, {"image_2", 2}, {"image_02", 2}};
  for (const auto& [name, camera] : names) {
    if (fs::is_directory(folder / name)) return ImageFolder{folder / name, camera};
  }
  return std::nullopt;
}

std::optional<fs::path> find_poses(const fs::path& folder) {
  const fs::path sequence = fs::weakly_canonical(folder).filename();
  for (const fs::path& place : {folder / "poses.txt", folder / ".." / ".." / "poses" / (sequence.string() + ".txt")}) {
    if (fs::exists(place)) return place;
  }
  return std::nullopt;
}

std::vector<double> twelve_numbers(const fs::path& path, const TextLine& line) {
  const std::size_t colon = line.text.find(':');
  const TextLine numbers{line.number, colon == std::string::npos ? line.text : line.text.substr(colon + 1)};
  std::vector<double> values = parse_numbers(path, numbers);
  if (values.size() == 12) return values;
  throw InputError(path, line.number, fmt::format("has {} numbers, a 3x4 matrix has 12", values.size()), "");
}

// Where camera `index` stands in the axes of camera 0: P = K [1 | K⁻¹ p₄], so X_index = X_0 + K⁻¹ p₄.
Eigen::Isometry3d place_of_camera(const fs::path& path, std::size_t index) {
  Eigen::Isometry3d T_camera0_camera = Eigen::Isometry3d::Identity();
  if (index == 0) return T_camera0_camera;
  const std::string name = fmt::format("P{}:", index);
  for (const TextLine& line : read_lines(path)) {
    if (!line.text.starts_with(name)) continue;
    const std::vector<double> numbers = twelve_numbers(path, line);
    const Eigen::Matrix<double, 3, 4> P =
        Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers.data());
    T_camera0_camera.translation() = -(P.leftCols<3>().inverse() * P.col(3));
  }
  return T_camera0_camera;
}

std::vector<Timestamp> read_times(const fs::path& folder, std::size_t count) {
  std::vector<Timestamp> times;
  if (const fs::path path = folder / "times.txt"; fs::exists(path)) {
    for (const TextLine& line : read_lines(path)) {
      times.emplace_back(from_seconds(parse_number(path, line.number, line.text)));
    }
    if (times.size() < count) {
      throw InputError(path, 0, fmt::format("has {} times for {} images", times.size(), count), "");
    }
    return times;
  }
  for (std::size_t i = 0; i < count; ++i) times.emplace_back(from_seconds(static_cast<double>(i) / kFrameRateHz));
  return times;
}

Camera read_left_camera(const fs::path& calibration, std::size_t index, const fs::path& image) {
  const cv::Mat pixels = read_image(image);
  const auto cameras = read_cameras(calibration, ImageSize{pixels.cols, pixels.rows});
  for (const NamedCamera& camera : cameras) {
    if (camera.name == fmt::format("P{}", index)) return camera.camera;
  }
  return cameras.front().camera;
}

}  // namespace

std::optional<Dataset> open_kitti(const fs::path& folder) {
  const fs::path calibration = folder / "calib.txt";
  const auto source = find_images(folder);
  if (!source || !fs::exists(calibration)) return std::nullopt;
  Dataset dataset{.kind = "kitti", .folder = folder, .timed = true};
  const std::vector<fs::path> images = list_images(source->path);
  dataset.camera = read_left_camera(calibration, source->camera, images.front());
  const Eigen::Isometry3d T_camera0_camera = place_of_camera(calibration, source->camera);
  const auto poses_file = find_poses(folder);
  const Trajectory poses = poses_file ? read_trajectory(*poses_file).poses : Trajectory{};
  if (poses_file && poses.size() != images.size()) {
    throw InputError(*poses_file, 0, fmt::format("has {} poses for {} images", poses.size(), images.size()), "");
  }
  const std::vector<Timestamp> times = read_times(folder, images.size());
  for (std::size_t i = 0; i < images.size(); ++i) {
    dataset.frames.push_back({times[i], images[i], std::nullopt, std::nullopt});
    if (!poses_file) continue;
    dataset.frames.back().T_world_camera = poses[i].T_world_camera * T_camera0_camera;
    dataset.truth.push_back({times[i], *dataset.frames.back().T_world_camera, std::nullopt});
  }
  return dataset;
}

}  // namespace alidade
