// SPDX-License-Identifier: Apache-2.0
#include "io/camera_yaml.h"

#include <array>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/errors.h"
#include "core/nearest_name.h"
#include "io/camera_records.h"
#include "io/yaml_nodes.h"

namespace alidade {
namespace {

using Path = std::filesystem::path;

// All numbers in a scalar, a list, a list of lists, or the `data` of a matrix, in order.
void append_numbers(const Path& path, const YAML::Node& node, std::vector<double>& numbers) {
  if (node.IsMap() && node["data"]) return append_numbers(path, node["data"], numbers);
  if (!node.IsSequence()) return numbers.push_back(yaml_number(path, node));
  for (const YAML::Node& item : node) append_numbers(path, item, numbers);
}

std::vector<double> numbers_of(const Path& path, const YAML::Node& node) {
  std::vector<double> numbers;
  if (!node.IsNull()) append_numbers(path, node, numbers);
  return numbers;
}

YAML::Node required(const Path& path, const YAML::Node& map, const char* key) {
  return yaml_value(path, map, key, "the camera");
}

void read_intrinsics(const Path& path, const YAML::Node& map, CameraRecord& record) {
  require_yaml_map(path, map, "{fx: 500, fy: 500, cx: 319.5, cy: 239.5}");
  constexpr std::array<std::string_view, 4> kKeys{"fx", "fy", "cx", "cy"};
  refuse_unknown_keys(path, map, kKeys);
  Camera& c = record.camera;
  double* const values[] = {&c.fx, &c.fy, &c.cx, &c.cy};
  for (std::size_t i = 0; i < kKeys.size(); ++i) {
    const YAML::Node value = required(path, map, kKeys[i].data());
    *values[i] = yaml_number(path, value);
    record.lines[std::string(kKeys[i])] = yaml_line(value);
  }
}

void read_distortion(const Path& path, const YAML::Node& map, CameraRecord& record) {
  require_yaml_map(path, map, "{k1: 0.1, k2: 0, p1: 0, p2: 0, k3: 0}");
  const auto names = coefficient_names(record.camera.distortion);
  refuse_unknown_keys(path, map, names);
  std::vector<double> values;
  for (const std::string_view name : names) {
    const YAML::Node value = map[std::string(name)];
    values.push_back(value ? yaml_number(path, value) : 0.0);
  }
  record.camera.distortion = with_coefficients(record.camera.distortion, values);
  record.lines["distortion"] = yaml_line(map);
}

void read_resolution(const Path& path, const YAML::Node& node, CameraRecord& record) {
  const bool pair = node.IsSequence() && node.size() == 2 && node[0].IsScalar() && node[1].IsScalar();
  if (!pair) throw InputError(path, yaml_line(node), "resolution_px must be [width, height]", "e.g. [640, 480]");
  record.camera.width = parse_size(path, yaml_line(node), node[0].Scalar());
  record.camera.height = parse_size(path, yaml_line(node), node[1].Scalar());
  record.lines["image"] = yaml_line(node);
}

CameraRecords read_own(const Path& path, const YAML::Node& root) {
  constexpr std::array<std::string_view, 2> kKeys{"camera", "cameras"};
  refuse_unknown_keys(path, root, kKeys);
  if (root["camera"] && root["cameras"]) throw InputError(path, 1, "has both 'camera' and 'cameras'", "keep one");
  if (root["camera"]) return {read_camera_node(path, root["camera"], 0)};
  const YAML::Node list = root["cameras"];
  if (!list.IsSequence() || list.size() == 0)
    throw InputError(path, yaml_line(list), "a list of cameras is wanted", "");
  CameraRecords records;
  for (const YAML::Node& node : list) records.push_back(read_camera_node(path, node, records.size()));
  return records;
}

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

// ROS says so; OpenCV's own files do not tell a fisheye from a radial lens with four coefficients.
bool is_equidistant(const YAML::Node& root) {
  const YAML::Node model = root["distortion_model"];
  return model && model.IsScalar() && (model.Scalar() == "equidistant" || model.Scalar() == "fisheye");
}

CameraRecord read_opencv_camera(const Path& path, const YAML::Node& root, const KeyPair& keys) {
  CameraRecord record;
  const YAML::Node matrix = root[keys.matrix];
  record.name = keys.name;
  record.line = yaml_line(matrix);
  set_intrinsics(path, record.line, numbers_of(path, matrix), record.camera);
  if (const YAML::Node distortion = root[keys.distortion]) {
    const std::vector<double> values = numbers_of(path, distortion);
    record.camera.distortion = is_equidistant(root) ? fisheye_from(path, yaml_line(distortion), values)
                                                    : distortion_from(path, yaml_line(distortion), values);
    record.lines["distortion"] = yaml_line(distortion);
  }
  read_opencv_size(path, root, record);
  return record;
}

CameraRecords read_opencv(const Path& path, const YAML::Node& root) {
  CameraRecords records;
  for (const KeyPair& keys : kKeyPairs) {
    if (!root[keys.matrix]) continue;
    const bool first = records.empty() || records.back().line != yaml_line(root[keys.matrix]);
    if (first)
      records.push_back(read_opencv_camera(path, root, keys));
    else if (root[keys.distortion])
      records.back() = read_opencv_camera(path, root, keys);
  }
  return records;
}

}  // namespace

CameraRecord read_camera_node(const Path& path, const YAML::Node& node, std::size_t index) {
  require_yaml_map(path, node, "camera: {model: pinhole, resolution_px: [640, 480], intrinsics_px: {fx: 500, ...}}");
  constexpr std::array<std::string_view, 6> kKeys{"name",          "model",      "resolution_px",
                                                  "intrinsics_px", "distortion", "readout_s"};
  refuse_unknown_keys(path, node, kKeys);
  CameraRecord record;
  record.line = yaml_line(node);
  record.name = node["name"] && node["name"].IsScalar() ? node["name"].Scalar() : fmt::format("camera {}", index);
  constexpr std::array<std::string_view, 3> kModels{"pinhole", "brown_conrady", "fisheye"};
  const std::string model_name = yaml_choice(path, required(path, node, "model"), "camera model", kModels);
  if (model_name == "fisheye") record.camera.distortion = Fisheye{};
  read_resolution(path, required(path, node, "resolution_px"), record);
  read_intrinsics(path, required(path, node, "intrinsics_px"), record);
  if (const YAML::Node distortion = node["distortion"]) {
    if (model_name == "pinhole") {
      throw InputError(path, yaml_line(distortion), "model pinhole has no distortion", "write model: brown_conrady");
    }
    read_distortion(path, distortion, record);
  }
  if (const YAML::Node readout = node["readout_s"]) {
    record.camera.readout_s = yaml_number(path, readout);
    record.lines["readout_s"] = yaml_line(readout);
  }
  return record;
}

CameraRecords parse_camera_yaml(const Path& path, const std::string& text) {
  std::string yaml = text;
  // OpenCV writes "%YAML:1.0", which is no directive of YAML's; as a comment it keeps the line numbers.
  if (yaml.starts_with("%YAML")) yaml.front() = '#';
  const YAML::Node root = load_yaml(path, yaml);
  if (root.IsMap()) {
    if (root["camera"] || root["cameras"]) return read_own(path, root);
    const CameraRecords records = read_opencv(path, root);
    if (!records.empty()) return records;
  }
  throw InputError(path, 0, "holds no camera", "a key 'camera', 'cameras' or 'camera_matrix' is wanted");
}

}  // namespace alidade
