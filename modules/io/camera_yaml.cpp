// SPDX-License-Identifier: Apache-2.0
#include "io/camera_yaml.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/errors.h"
#include "core/nearest_name.h"
#include "io/camera_records.h"
#include "io/pose_yaml.h"
#include "io/yaml_nodes.h"

namespace alidade {
namespace {

using Path = std::filesystem::path;

constexpr const char* kCameraExample =
    "camera: {model: pinhole, resolution_px: [640, 480], intrinsics_px: {fx: 500, ...}}";

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
  if (root["camera"]) return {read_rig_camera_node(path, root["camera"], 0)};
  const YAML::Node list = root["cameras"];
  if (!list.IsSequence() || list.size() == 0)
    throw InputError(path, yaml_line(list), "a list of cameras is wanted", "");
  CameraRecords records;
  std::set<std::string> names;
  for (const YAML::Node& node : list) {
    records.push_back(read_rig_camera_node(path, node, records.size()));
    const std::string& name = records.back().name;
    if (!names.insert(name).second) {
      throw InputError(path, yaml_line(node), fmt::format("two cameras are named '{}'", name), "rename one");
    }
  }
  return records;
}

Eigen::MatrixXd read_intrinsics_covariance(const Path& path, const YAML::Node& node, const Camera& camera) {
  require_yaml_map(path, node, "{parameters: [fx, fy, cx, cy], covariance: [...]}");
  constexpr std::array<std::string_view, 2> kKeys{"parameters", "covariance"};
  refuse_unknown_keys(path, node, kKeys);
  const YAML::Node list = yaml_value(path, node, "parameters", "the covariance");
  if (!list.IsSequence() || list.size() == 0) {
    throw InputError(path, yaml_line(list), "a list of names is wanted here", "e.g. [fx, fy, cx, cy]");
  }
  const std::vector<std::string> names = intrinsics_names(camera);
  const std::vector<std::string_view> known(names.begin(), names.end());
  std::vector<Eigen::Index> places;
  for (const YAML::Node& item : list) {
    const std::string name = yaml_choice(path, item, "parameter", known);
    const Eigen::Index place = std::find(known.begin(), known.end(), name) - known.begin();
    if (std::find(places.begin(), places.end(), place) != places.end()) {
      throw InputError(path, yaml_line(item), fmt::format("'{}' is listed twice", name), "");
    }
    places.push_back(place);
  }
  const auto count = static_cast<Eigen::Index>(names.size());
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(count, count);
  const YAML::Node values = yaml_value(path, node, "covariance", "the covariance");
  C(places, places) = read_covariance(path, values, static_cast<int>(places.size()));
  return C;
}

constexpr std::array<std::string_view, 10> kCameraKeys{
    "name",      "model",        "resolution_px",   "intrinsics_px",         "distortion",
    "readout_s", "T_rig_camera", "pose_covariance", "intrinsics_covariance", "clock_offset_s"};
constexpr std::size_t kKeysOfCameraAlone = 6;

CameraRecord read_camera_map(const Path& path, const YAML::Node& node, std::size_t index) {
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

}  // namespace

CameraRecord read_camera_node(const Path& path, const YAML::Node& node, std::size_t index) {
  require_yaml_map(path, node, kCameraExample);
  refuse_unknown_keys(path, node, std::span(kCameraKeys).first(kKeysOfCameraAlone));
  return read_camera_map(path, node, index);
}

CameraRecord read_rig_camera_node(const Path& path, const YAML::Node& node, std::size_t index) {
  require_yaml_map(path, node, kCameraExample);
  refuse_unknown_keys(path, node, kCameraKeys);
  CameraRecord record = read_camera_map(path, node, index);
  if (const YAML::Node pose = node["T_rig_camera"]) record.T_rig_camera = read_pose(path, pose);
  if (const YAML::Node covariance = node["pose_covariance"]) {
    record.pose_covariance = read_covariance(path, covariance, 6);
  }
  if (const YAML::Node covariance = node["intrinsics_covariance"]) {
    record.intrinsics_covariance = read_intrinsics_covariance(path, covariance, record.camera);
  }
  if (const YAML::Node offset = node["clock_offset_s"]) record.clock_offset_s = yaml_number(path, offset);
  return record;
}

CameraRecords parse_camera_yaml(const Path& path, const std::string& text) {
  std::string yaml = text;
  // OpenCV writes "%YAML:1.0", which is no directive of YAML's; as a comment it keeps the line numbers.
  if (yaml.starts_with("%YAML")) yaml.front() = '#';
  const YAML::Node root = load_yaml(path, yaml);
  if (root.IsMap()) {
    if (root["camera"] || root["cameras"]) return read_own(path, root);
    if (root["cam0"]) return read_kalibr_chain(path, root);
    const CameraRecords records = read_opencv_yaml(path, root);
    if (!records.empty()) return records;
  }
  throw InputError(path, 0, "holds no camera", "a key 'camera', 'cameras', 'cam0' or 'camera_matrix' is wanted");
}

}  // namespace alidade
