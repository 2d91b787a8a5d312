// SPDX-License-Identifier: Apache-2.0
#include "io/camera_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "core/errors.h"
#include "io/camera_records.h"
#include "io/text_lines.h"

namespace alidade {
namespace {

constexpr const char* kFormats =
    "known are the YAML of Alidade, OpenCV, ROS and Kalibr, OpenCV's XML, COLMAP's cameras.txt, mrcal's *.cameramodel, "
    "'fx 500 fy 500 cx 320 cy 240', Strecha's *.camera and KITTI's calib.txt";

bool is_number(std::string_view word) {
  return !word.empty() && word.find_first_not_of("0123456789.+-eE") == std::string_view::npos;
}

bool is_name(std::string_view word) {
  return !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c); }) &&
         std::isalpha(static_cast<unsigned char>(word.front()));
}

bool is_projection_line(const TextLine& line) {
  return line.text.starts_with("P0:") || line.text.starts_with("P1:") || line.text.starts_with("P2:") ||
         line.text.starts_with("P_rect_0");
}

bool is_yaml(const std::filesystem::path& path, const std::vector<TextLine>& lines) {
  const auto extension = path.extension();
  if (extension == ".yaml" || extension == ".yml") return true;
  const std::string_view first = split_words(lines.front().text).front();
  return first.starts_with("%YAML") || first == "---" || first.ends_with(':');
}

CameraRecords parse(const std::filesystem::path& path) {
  const std::string text = read_bytes(path);
  const std::vector<TextLine> lines = significant_lines(text);
  if (lines.empty()) throw InputError(path, 0, "is empty, a camera is wanted", kFormats);
  if (lines.front().text.starts_with("<?xml") || lines.front().text.starts_with("<opencv_storage")) {
    return parse_opencv_xml(path, text);
  }
  if (lines.front().text.starts_with('{') && text.find("lensmodel") != std::string::npos) {
    return parse_mrcal_model(path, text);
  }
  if (std::any_of(lines.begin(), lines.end(), is_projection_line)) return parse_kitti_calibration(path, lines);
  if (is_yaml(path, lines)) return parse_camera_yaml(path, text);
  const auto words = split_words(lines.front().text);
  if (words.size() >= 2 && is_name(words[0]) && is_number(words[1])) return parse_camera_words(path, lines);
  if (words.size() >= 4 && is_number(words[0]) && std::isupper(static_cast<unsigned char>(words[1].front()))) {
    return parse_colmap_cameras(path, lines);
  }
  if (words.size() == 12 && is_number(words[0])) return parse_kitti_calibration(path, lines);
  if (words.size() == 3 && is_number(words[0])) return parse_camera_matrix(path, lines);
  throw InputError(path, lines.front().number, "is not a camera file", kFormats);
}

// The line of the value that a fault is about: find_fault's sentences start with its name.
int line_of(const CameraRecord& record, const std::string& fault) {
  const auto found = record.lines.find(fault.substr(0, fault.find(' ')));
  return found == record.lines.end() ? record.line : found->second;
}

CameraRecord checked(const std::filesystem::path& path, CameraRecord record, std::optional<ImageSize> size) {
  Camera& camera = record.camera;
  if (camera.width == 0 && camera.height == 0) {
    if (!size) throw InputError(path, record.line, "says no image size", "give it the images' width and height");
    camera.width = size->width;
    camera.height = size->height;
  }
  if (const auto fault = find_fault(camera)) {
    throw InputError(path, line_of(record, *fault), fmt::format("camera '{}': {}", record.name, *fault),
                     "correct the file or calibrate the camera again");
  }
  return record;
}

}  // namespace

CameraRecords read_camera_records(const std::filesystem::path& path, std::optional<ImageSize> size_of_images) {
  CameraRecords records;
  for (CameraRecord& record : parse(path)) records.push_back(checked(path, std::move(record), size_of_images));
  return records;
}

Eigen::Isometry3d pose_from(const std::filesystem::path& path, int line, std::span<const double> R,
                            std::span<const double> t) {
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const bool shaped = R.size() == 9 && t.size() == 3;
  const Rows M = shaped ? Rows(Eigen::Map<const Rows>(R.data())) : Rows::Zero();
  if (!(M.transpose() * M).isIdentity(1e-3) || !(M.determinant() > 0)) {
    throw InputError(path, line, "is no pose", "a 3x3 rotation matrix and a translation in m are wanted");
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(M).normalized().toRotationMatrix();
  T.translation() = Eigen::Map<const Eigen::Vector3d>(t.data());
  return T;
}

void set_intrinsics(const std::filesystem::path& path, int line, std::span<const double> K, Camera& camera) {
  const bool shaped = K.size() == 9 && K[3] == 0 && K[6] == 0 && K[7] == 0 && K[8] == 1;
  if (!shaped) {
    throw InputError(path, line, "is no camera matrix", "[fx 0 cx; 0 fy cy; 0 0 1] is wanted");
  }
  if (std::abs(K[1]) > 1e-6 * std::abs(K[0])) {
    throw InputError(path, line, fmt::format("the camera matrix has a skew of {} px, which is not supported", K[1]),
                     "calibrate without skew");
  }
  camera.fx = K[0];
  camera.cx = K[2];
  camera.fy = K[4];
  camera.cy = K[5];
}

int parse_size(const std::filesystem::path& path, int line, std::string_view word) {
  const long long size = parse_integer(path, line, word);
  if (size < 0 || size > 1'000'000) throw InputError(path, line, fmt::format("{} is no image size in px", size), "");
  return static_cast<int>(size);
}

Distortion distortion_from(const std::filesystem::path& path, int line, std::span<const double> k) {
  const bool other_model = std::any_of(k.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(8, k.size())),
                                       k.end(), [](double value) { return value != 0; });
  if (other_model) {
    throw InputError(path, line, fmt::format("distortion with {} coefficients is not supported", k.size()),
                     "calibrate with k1 k2 p1 p2 k3 k4 k5 k6, without thin prisms and tilt");
  }
  const auto at = [&](std::size_t i) { return i < k.size() ? k[i] : 0.0; };
  return BrownConrady{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)};
}

Fisheye fisheye_from(const std::filesystem::path& path, int line, std::span<const double> k) {
  if (k.size() != 4) throw InputError(path, line, fmt::format("a fisheye has 4 coefficients, got {}", k.size()), "");
  return {k[0], k[1], k[2], k[3]};
}

std::vector<NamedCamera> read_cameras(const std::filesystem::path& path, std::optional<ImageSize> size_of_images) {
  std::vector<NamedCamera> cameras;
  for (const CameraRecord& record : read_camera_records(path, size_of_images)) {
    cameras.push_back({record.name, record.camera});
  }
  return cameras;
}

Camera read_camera(const std::filesystem::path& path, std::optional<ImageSize> size_of_images) {
  const std::vector<NamedCamera> cameras = read_cameras(path, size_of_images);
  for (const NamedCamera& other : cameras) {
    if (other.camera == cameras.front().camera) continue;
    throw InputError(path, 0,
                     fmt::format("holds {} cameras ('{}', '{}', ...), one is wanted", cameras.size(),
                                 cameras.front().name, other.name),
                     "keep only the one of these images");
  }
  return cameras.front().camera;
}

}  // namespace alidade
