// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <span>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/errors.h"
#include "geometry/rotation.h"
#include "io/camera_records.h"
#include "io/yaml_nodes.h"

// mrcal's .cameramodel: a literal of Python's, which is YAML but for its byte strings.
// Source: https://mrcal.secretsauce.net/cameramodels.html
namespace alidade {
namespace {

using Path = std::filesystem::path;

struct MrcalModel {
  std::string_view name;
  std::size_t coefficients;  // in OpenCV's order
};
constexpr std::array<MrcalModel, 5> kModels{{{"LENSMODEL_PINHOLE", 0},
                                             {"LENSMODEL_OPENCV4", 4},
                                             {"LENSMODEL_OPENCV5", 5},
                                             {"LENSMODEL_OPENCV8", 8},
                                             {"LENSMODEL_OPENCV12", 12}}};

YAML::Node required(const Path& path, const YAML::Node& map, const char* key) {
  return yaml_value(path, map, key, "the camera model");
}

// The data of the optimization, b'...', becomes a string: its base 85 has neither quotes nor backslashes.
std::string without_byte_strings(std::string text) {
  for (std::size_t at = text.find("b'"); at != std::string::npos; at = text.find("b'", at + 2)) {
    const std::size_t before = text.find_last_not_of(" \t\r\n", at - 1);
    if (at > 0 && before != std::string::npos && text[before] == ':') text[at] = ' ';
  }
  return text;
}

void read_lens(const Path& path, const YAML::Node& root, CameraRecord& record) {
  std::vector<std::string_view> names;
  for (const MrcalModel& model : kModels) names.push_back(model.name);
  const std::string name = yaml_choice(path, required(path, root, "lensmodel"), "or unsupported lensmodel", names);
  const auto model = std::find_if(kModels.begin(), kModels.end(), [&](const auto& m) { return m.name == name; });
  const YAML::Node list = required(path, root, "intrinsics");
  const auto values = yaml_numbers(path, list, 4 + model->coefficients, "[fx, fy, cx, cy, k1, k2, ...]");
  Camera& c = record.camera;
  c.fx = values[0];
  c.fy = values[1];
  c.cx = values[2];
  c.cy = values[3];
  c.distortion = distortion_from(path, yaml_line(list), std::span(values).subspan(4));
  for (const char* key : {"fx", "fy", "cx", "cy", "distortion"}) record.lines[key] = yaml_line(list);
}

}  // namespace

CameraRecords parse_mrcal_model(const Path& path, const std::string& text) {
  const YAML::Node root = load_yaml(path, without_byte_strings(text));
  CameraRecord record;
  record.name = path.stem();
  record.line = yaml_line(root);
  read_lens(path, root, record);
  const YAML::Node size = required(path, root, "imagersize"), pose = required(path, root, "extrinsics");
  yaml_numbers(path, size, 2, "[640, 480]");
  record.camera.width = parse_size(path, yaml_line(size), size[0].Scalar());
  record.camera.height = parse_size(path, yaml_line(size), size[1].Scalar());
  record.lines["image"] = yaml_line(size);
  const auto rt = yaml_numbers(path, pose, 6, "[rx, ry, rz, tx, ty, tz]");
  Eigen::Isometry3d T_camera_rig = Eigen::Isometry3d::Identity();
  T_camera_rig.linear() = exp_so3({rt[0], rt[1], rt[2]});
  T_camera_rig.translation() = Eigen::Vector3d(rt[3], rt[4], rt[5]);
  record.T_rig_camera = T_camera_rig.inverse();
  return {record};
}

std::string format_mrcal_model(const RigCamera& c) {
  const Intrinsics values = intrinsics(c.camera);
  Eigen::Index used = values.size();
  while (used > 4 && values[used - 1] == 0) --used;
  // The smallest model that holds all coefficients in use.
  const auto model = std::find_if(kModels.begin(), kModels.end(), [&](const MrcalModel& m) {
    return static_cast<Eigen::Index>(4 + m.coefficients) >= used;
  });
  const auto numbers = std::span(values.data(), 4 + model->coefficients);
  const Eigen::Isometry3d T_camera_rig = c.T_rig_camera.inverse();
  const Eigen::Vector3d r = log_so3(T_camera_rig.linear()), t = T_camera_rig.translation();
  return fmt::format(
      "{{\n    'lensmodel': '{}',\n    'intrinsics': [ {} ],\n    # rt_cam_ref: rotation vector and translation that "
      "map "
      "points of the rig into the camera\n    'extrinsics': [ {}, {}, {}, {}, {}, {} ],\n    'imagersize': [ {}, {} "
      "],\n"
      "}}\n",
      model->name, fmt::join(numbers, ", "), r.x(), r.y(), r.z(), t.x(), t.y(), t.z(), c.camera.width, c.camera.height);
}

}  // namespace alidade
