// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/errors.h"
#include "core/nearest_name.h"
#include "io/camera_records.h"

namespace alidade {
namespace {

using Path = std::filesystem::path;

int line_of(const YAML::Node& node) {
  return node.Mark().line + 1;
}

double number(const Path& path, const YAML::Node& node) {
  if (!node.IsScalar()) throw InputError(path, line_of(node), "a number is wanted here", "");
  return parse_number(path, line_of(node), node.Scalar());
}

// All numbers in a scalar, a list, a list of lists, or the `data` of a matrix, in order.
void append_numbers(const Path& path, const YAML::Node& node, std::vector<double>& numbers) {
  if (node.IsMap() && node["data"]) return append_numbers(path, node["data"], numbers);
  if (!node.IsSequence()) return numbers.push_back(number(path, node));
  for (const YAML::Node& item : node) append_numbers(path, item, numbers);
}

std::vector<double> numbers_of(const Path& path, const YAML::Node& node) {
  std::vector<double> numbers;
  if (!node.IsNull()) append_numbers(path, node, numbers);
  return numbers;
}

void refuse_unknown_keys(const Path& path, const YAML::Node& map, std::span<const std::string_view> known) {
  for (const auto& entry : map) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    throw InputError(path, line_of(entry.first), fmt::format("unknown key '{}'", key), suggest_name(key, known));
  }
}

YAML::Node required(const Path& path, const YAML::Node& map, const char* key) {
  const YAML::Node value = map[key];
  if (!value) throw InputError(path, line_of(map), fmt::format("the camera has no '{}'", key), "");
  return value;
}

void require_map(const Path& path, const YAML::Node& node, const char* example) {
  if (node.IsMap()) return;
  throw InputError(path, line_of(node), "names with values are wanted here", fmt::format("e.g. {}", example));
}

void read_intrinsics(const Path& path, const YAML::Node& map, CameraRecord& record) {
  require_map(path, map, "{fx: 500, fy: 500, cx: 319.5, cy: 239.5}");
  constexpr std::array<std::string_view, 4> kKeys{"fx", "fy", "cx", "cy"};
  refuse_unknown_keys(path, map, kKeys);
  Camera& c = record.camera;
  double* const values[] = {&c.fx, &c.fy, &c.cx, &c.cy};
  for (std::size_t i = 0; i < kKeys.size(); ++i) {
    const YAML::Node value = required(path, map, kKeys[i].data());
    *values[i] = number(path, value);
    record.lines[std::string(kKeys[i])] = line_of(value);
  }
}

void read_distortion(const Path& path, const YAML::Node& map, CameraRecord& record) {
  require_map(path, map, "{k1: 0.1, k2: 0, p1: 0, p2: 0, k3: 0}");
  constexpr std::array<std::string_view, 5> kKeys{"k1", "k2", "p1", "p2", "k3"};
  refuse_unknown_keys(path, map, kKeys);
  BrownConrady& k = record.camera.distortion;
  double* const values[] = {&k.k1, &k.k2, &k.p1, &k.p2, &k.k3};
  for (std::size_t i = 0; i < kKeys.size(); ++i) {
    if (const YAML::Node value = map[kKeys[i].data()]) *values[i] = number(path, value);
  }
  record.lines["distortion"] = line_of(map);
}

void read_resolution(const Path& path, const YAML::Node& node, CameraRecord& record) {
  const bool pair = node.IsSequence() && node.size() == 2 && node[0].IsScalar() && node[1].IsScalar();
  if (!pair) throw InputError(path, line_of(node), "resolution_px must be [width, height]", "e.g. [640, 480]");
  record.camera.width = parse_size(path, line_of(node), node[0].Scalar());
  record.camera.height = parse_size(path, line_of(node), node[1].Scalar());
  record.lines["image"] = line_of(node);
}

CameraRecord read_camera_node(const Path& path, const YAML::Node& node, std::size_t index) {
  require_map(path, node, "camera: {model: pinhole, resolution_px: [640, 480], intrinsics_px: {fx: 500, ...}}");
  constexpr std::array<std::string_view, 6> kKeys{"name",          "model",      "resolution_px",
                                                  "intrinsics_px", "distortion", "readout_s"};
  refuse_unknown_keys(path, node, kKeys);
  CameraRecord record;
  record.line = line_of(node);
  record.name = node["name"] && node["name"].IsScalar() ? node["name"].Scalar() : fmt::format("camera {}", index);
  const YAML::Node model = required(path, node, "model");
  constexpr std::array<std::string_view, 2> kModels{"pinhole", "brown_conrady"};
  const std::string model_name = model.IsScalar() ? model.Scalar() : "";
  if (std::find(kModels.begin(), kModels.end(), model_name) == kModels.end()) {
    throw InputError(path, line_of(model), fmt::format("unknown camera model '{}'", model_name),
                     suggest_name(model_name, kModels));
  }
  read_resolution(path, required(path, node, "resolution_px"), record);
  read_intrinsics(path, required(path, node, "intrinsics_px"), record);
  if (const YAML::Node distortion = node["distortion"]) {
    if (model_name == "pinhole") {
      throw InputError(path, line_of(distortion), "model pinhole has no distortion", "write model: brown_conrady");
    }
    read_distortion(path, distortion, record);
  }
  if (const YAML::Node readout = node["readout_s"]) {
    record.camera.readout_s = number(path, readout);
    record.lines["readout_s"] = line_of(readout);
  }
  return record;
}

CameraRecords read_own(const Path& path, const YAML::Node& root) {
  constexpr std::array<std::string_view, 2> kKeys{"camera", "cameras"};
  refuse_unknown_keys(path, root, kKeys);
  if (root["camera"] && root["cameras"]) throw InputError(path, 1, "has both 'camera' and 'cameras'", "keep one");
  if (root["camera"]) return {read_camera_node(path, root["camera"], 0)};
  const YAML::Node list = root["cameras"];
  if (!list.IsSequence() || list.size() == 0) throw InputError(path, line_of(list), "a list of cameras is wanted", "");
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
    record.camera.width = parse_size(path, line_of(root[width]), root[width].Scalar());
    record.camera.height = parse_size(path, line_of(root[height]), root[height].Scalar());
    record.lines["image"] = line_of(root[width]);
  }
}

CameraRecord read_opencv_camera(const Path& path, const YAML::Node& root, const KeyPair& keys) {
  CameraRecord record;
  const YAML::Node matrix = root[keys.matrix];
  record.name = keys.name;
  record.line = line_of(matrix);
  set_intrinsics(path, record.line, numbers_of(path, matrix), record.camera);
  if (const YAML::Node distortion = root[keys.distortion]) {
    record.camera.distortion = distortion_from(path, line_of(distortion), numbers_of(path, distortion));
    record.lines["distortion"] = line_of(distortion);
  }
  read_opencv_size(path, root, record);
  return record;
}

CameraRecords read_opencv(const Path& path, const YAML::Node& root) {
  if (const YAML::Node model = root["distortion_model"]; model && model.IsScalar() && model.Scalar() == "equidistant") {
    throw InputError(path, line_of(model), "the distortion model 'equidistant' is not supported", "");
  }
  CameraRecords records;
  for (const KeyPair& keys : kKeyPairs) {
    if (!root[keys.matrix]) continue;
    const bool first = records.empty() || records.back().line != line_of(root[keys.matrix]);
    if (first)
      records.push_back(read_opencv_camera(path, root, keys));
    else if (root[keys.distortion])
      records.back() = read_opencv_camera(path, root, keys);
  }
  return records;
}

}  // namespace

CameraRecords parse_camera_yaml(const Path& path, const std::string& text) {
  std::string yaml = text;
  // OpenCV writes "%YAML:1.0", which is no directive of YAML's; as a comment it keeps the line numbers.
  if (yaml.starts_with("%YAML")) yaml.front() = '#';
  try {
    const YAML::Node root = YAML::Load(yaml);
    if (root.IsMap()) {
      if (root["camera"] || root["cameras"]) return read_own(path, root);
      const CameraRecords records = read_opencv(path, root);
      if (!records.empty()) return records;
    }
    throw InputError(path, 0, "holds no camera", "a key 'camera', 'cameras' or 'camera_matrix' is wanted");
  } catch (const YAML::Exception& e) {
    throw InputError(path, e.mark.line + 1, "damaged YAML: " + e.msg, "correct the line or write the file again");
  }
}

}  // namespace alidade
