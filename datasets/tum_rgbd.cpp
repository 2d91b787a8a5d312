// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <regex>

#include <fmt/format.h>

#include "core/errors.h"
#include "datasets/dataset.h"
#include "datasets/find_camera.h"
#include "io/text_lines.h"
#include "io/trajectory_file.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;

constexpr auto kLongestGap = std::chrono::milliseconds(100);  // motion capture runs at 100 Hz
constexpr auto kSameMoment = std::chrono::milliseconds(20);   // colour and depth are up to half a frame apart
constexpr double kDepthUnitM = 1.0 / 5000.0;

struct TimedFile {
  Timestamp time{};
  fs::path path;
};

std::vector<TimedFile> read_file_list(const fs::path& list) {
  std::vector<TimedFile> files;
  for (const TextLine& line : read_lines(list)) {
    const auto words = split_words(line.text);
    const auto time = words.size() == 2 ? parse_seconds(words[0]) : std::nullopt;
    if (!time) throw InputError(list, line.number, "'timestamp filename' is wanted", "");
    if (!files.empty() && *time <= files.back().time) throw InputError(list, line.number, "time does not increase", "");
    files.push_back({*time, list.parent_path() / words[1]});
    if (!fs::exists(files.back().path)) {
      throw InputError(list, line.number, fmt::format("there is no file '{}'", words[1]), "");
    }
  }
  return files;
}

// Gives each depth image to the colour image nearest in time.
void assign_depth(const std::vector<TimedFile>& depth, std::vector<DatasetFrame>& frames) {
  for (const TimedFile& file : depth) {
    const auto nearest = std::min_element(frames.begin(), frames.end(), [&](const auto& a, const auto& b) {
      return std::chrono::abs(a.time - file.time) < std::chrono::abs(b.time - file.time);
    });
    if (nearest != frames.end() && std::chrono::abs(nearest->time - file.time) <= kSameMoment) {
      nearest->depth = file.path;
      nearest->depth_time = file.time;
    }
  }
}

// Of the Kinect's colour camera; not published. The least mean square reprojection error of freiburg1_rpy in its own
// map is found here, at two thirds of what it is without.
constexpr double kKinectReadoutS = 0.008;

// Others write data sets of this form, too.
bool is_of_the_kinect(const fs::path& folder) {
  static const std::regex kName("(freiburg|fr)[123]");
  return std::regex_search(fs::weakly_canonical(folder).filename().string(), kName);
}

// Source: the set's web page, "Intrinsic camera calibration of the Kinect", OpenCV's model, 640×480.
std::optional<Camera> published_camera(const fs::path& folder) {
  const std::string name = fs::weakly_canonical(folder).filename();
  if (name.find("freiburg1") != std::string::npos) {
    return Camera{640, 480, 517.3, 516.5, 318.6, 255.3, BrownConrady{0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};
  }
  if (name.find("freiburg2") != std::string::npos) {
    return Camera{640, 480, 520.9, 521.0, 325.1, 249.7, BrownConrady{0.2312, -0.7849, -0.0033, -0.0001, 0.9172}};
  }
  if (name.find("freiburg3") != std::string::npos) return Camera{640, 480, 535.4, 539.2, 320.1, 247.6, {}};
  return std::nullopt;
}

}  // namespace

std::optional<Dataset> open_tum_rgbd(const fs::path& folder) {
  if (!fs::exists(folder / "rgb.txt")) return std::nullopt;
  Dataset dataset{.kind = "tum-rgbd", .folder = folder, .depth_unit_m = kDepthUnitM, .timed = true};
  if (fs::exists(folder / "groundtruth.txt")) dataset.truth = read_trajectory(folder / "groundtruth.txt").poses;
  for (const TimedFile& file : read_file_list(folder / "rgb.txt")) {
    dataset.frames.push_back({file.time, file.path, std::nullopt, pose_at(dataset.truth, file.time, kLongestGap)});
  }
  if (dataset.frames.empty()) throw InputError(folder / "rgb.txt", 0, "lists no images", "");
  if (fs::exists(folder / "depth.txt")) assign_depth(read_file_list(folder / "depth.txt"), dataset.frames);
  dataset.camera = find_camera(folder, "camera.txt", dataset.frames.front().image);
  if (!dataset.camera) dataset.camera = published_camera(folder);
  if (dataset.camera && dataset.camera->readout_s == 0 && is_of_the_kinect(folder)) {
    dataset.camera->readout_s = kKinectReadoutS;
  }
  return dataset;
}

}  // namespace alidade
