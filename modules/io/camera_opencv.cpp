// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <span>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/errors.h"
#include "io/camera_records.h"
#include "io/camera_yaml.h"
#include "io/yaml_nodes.h"

// OpenCV's YAML and that of ROS' camera_info, which has the same matrices under the same names.
namespace alidade {
namespace {

using Path = std::filesystem::path;

// The names that calibration programs give to K and the distortion.
struct KeyPair {
  const char* name;
  const char* matrix;
  const char* distortion;
};
constexpr KeyPair kKeyPairs[] = {
    {"camera", "camera_matrix", "distortion_coefficients"},
    {"camera", "camera_matrix", "dist_coeff"},
    {"camera", "camera_matrix", "dist_coeffs"},
    {"camera", "camera_matrix", "distortion"},
    {"camera", "Camera_Matrix", "Distortion_Coefficients"},
    {"camera", "cameraMatrix", "distCoeffs"},
    {"camera", "K", "D"},
    {"left", "M1", "D1"},
    {"right", "M2", "D2"},
    {"left", "K1", "D1"},
    {"right", "K2", "D2"},
};

void read_opencv_size(const Path& path, const YAML::Node& root, CameraRecord& record) {
  constexpr const char* kNames[][2] = {
      {"image_width", "image_height"}, {"image_Width", "image_Height"}, {"width", "height"}};
  for (const auto& [width, height] : kNames) {
    if (!root[width] || !root[height]) continue;
    record.camera.width = parse_size(path, yaml_line(root[width]), root[width].Scalar());
    record.camera.height = parse_size(path, yaml_line(root[height]), root[height].Scalar());
    record.lines["image"] = yaml_line(root[width]);
  }
}

// ROS says so, and the file of OpenCV's calibration program; files that say nothing have a radial lens.
bool is_equidistant(const YAML::Node& root) {
  const YAML::Node model = root["distortion_model"], flag = root["fisheye_model"];
  if (flag && flag.IsScalar() && flag.Scalar() == "1") return true;
  return model && model.IsScalar() && (model.Scalar() == "equidistant" || model.Scalar() == "fisheye");
}

CameraRecord read_opencv_camera(const Path& path, const YAML::Node& root, const KeyPair& keys) {
  CameraRecord record;
  const YAML::Node matrix = root[keys.matrix];
  const YAML::Node name = root["camera_name"];
  record.name = name && name.IsScalar() && !name.Scalar().empty() ? name.Scalar() : keys.name;
  record.line = yaml_line(matrix);
  set_intrinsics(path, record.line, yaml_all_numbers(path, matrix), record.camera);
  if (const YAML::Node distortion = root[keys.distortion]) {
    const std::vector<double> values = yaml_all_numbers(path, distortion);
    record.camera.distortion = is_equidistant(root) ? fisheye_from(path, yaml_line(distortion), values)
                                                    : distortion_from(path, yaml_line(distortion), values);
    record.lines["distortion"] = yaml_line(distortion);
  }
  read_opencv_size(path, root, record);
  return record;
}

std::string format_numbers(std::span<const double> values) {
  return fmt::format("{}", fmt::join(values, ", "));
}

std::string format_opencv_matrix(const char* name, int rows, std::span<const double> values) {
  return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: [ {} ]\n", name, rows,
                     values.size() / static_cast<std::size_t>(rows), format_numbers(values));
}

std::string format_ros_matrix(const char* name, int rows, std::span<const double> values) {
  return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: [{}]\n", name, rows,
                     values.size() / static_cast<std::size_t>(rows), format_numbers(values));
}

std::array<double, 9> rows_of(const Eigen::Matrix3d& M) {
  return {M(0, 0), M(0, 1), M(0, 2), M(1, 0), M(1, 1), M(1, 2), M(2, 0), M(2, 1), M(2, 2)};
}

// k1 k2 p1 p2 k3, and k4 k5 k6 where one of them is used; the four of a fisheye.
std::vector<double> coefficients_in_use(const Distortion& distortion) {
  const DistortionCoefficients k = coefficients(distortion);
  const bool rational = k.size() == 8 && !k.tail<3>().isZero(0);
  return {k.data(), k.data() + (k.size() == 8 && !rational ? 5 : k.size())};
}

bool is_fisheye(const Camera& camera) {
  return std::holds_alternative<Fisheye>(camera.distortion);
}

}  // namespace

CameraRecords read_opencv_yaml(const Path& path, const YAML::Node& root) {
  CameraRecords records;
  for (const KeyPair& keys : kKeyPairs) {
    if (!root[keys.matrix]) continue;
    const bool first = records.empty() || records.back().line != yaml_line(root[keys.matrix]);
    if (first)
      records.push_back(read_opencv_camera(path, root, keys));
    else if (root[keys.distortion])
      records.back() = read_opencv_camera(path, root, keys);
  }
  const bool stereo = records.size() == 2 && records[0].name == "left" && records[1].name == "right";
  if (stereo && root["R"] && root["T"]) {
    const YAML::Node R = root["R"], t = root["T"];
    const auto rotation = yaml_all_numbers(path, R), translation = yaml_all_numbers(path, t);
    records[1].T_rig_camera = pose_from(path, yaml_line(R), rotation, translation).inverse();
  }
  return records;
}

std::string format_opencv_cameras(const CameraRig& rig) {
  const bool stereo = rig.cameras.size() == 2;
  const Camera& first = rig.cameras.front().camera;
  std::string text = fmt::format("%YAML:1.0\n---\nimage_width: {}\nimage_height: {}\n", first.width, first.height);
  if (is_fisheye(first)) text += "fisheye_model: 1\n";
  constexpr const char* kNames[3][2] = {{"camera_matrix", "distortion_coefficients"}, {"M1", "D1"}, {"M2", "D2"}};
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const Camera& camera = rig.cameras[i].camera;
    const auto& [matrix, distortion] = kNames[stereo ? i + 1 : 0];
    text += format_opencv_matrix(matrix, 3, rows_of(calibration_matrix(camera)));
    text += format_opencv_matrix(distortion, 1, coefficients_in_use(camera.distortion));
  }
  if (!stereo) return text;
  const Eigen::Isometry3d T_right_left = rig.cameras[1].T_rig_camera.inverse() * rig.cameras[0].T_rig_camera;
  const Eigen::Vector3d t = T_right_left.translation();
  text += format_opencv_matrix("R", 3, rows_of(T_right_left.linear()));
  return text + format_opencv_matrix("T", 3, std::span(t.data(), 3));
}

std::string format_ros_camera(const RigCamera& c) {
  const Eigen::Matrix3d K = calibration_matrix(c.camera);
  const double P[] = {K(0, 0), 0, K(0, 2), 0, 0, K(1, 1), K(1, 2), 0, 0, 0, 1, 0};
  const std::vector<double> k = coefficients_in_use(c.camera.distortion);
  const char* model = is_fisheye(c.camera) ? "equidistant" : k.size() == 8 ? "rational_polynomial" : "plumb_bob";
  std::string text = fmt::format("image_width: {}\nimage_height: {}\ncamera_name: {}\n", c.camera.width,
                                 c.camera.height, quoted_yaml(c.name));
  text += format_ros_matrix("camera_matrix", 3, rows_of(K));
  text += fmt::format("distortion_model: {}\n", model) + format_ros_matrix("distortion_coefficients", 1, k);
  text += format_ros_matrix("rectification_matrix", 3, rows_of(Eigen::Matrix3d::Identity()));
  return text + format_ros_matrix("projection_matrix", 3, P);
}

}  // namespace alidade
