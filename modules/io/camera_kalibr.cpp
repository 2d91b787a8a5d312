// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/errors.h"
#include "io/camera_records.h"
#include "io/camera_yaml.h"
#include "io/yaml_nodes.h"

// Kalibr's camchain. Source: https://github.com/ethz-asl/kalibr/wiki/yaml-formats
namespace alidade {
namespace {

using Path = std::filesystem::path;

YAML::Node required(const Path& path, const YAML::Node& map, const char* key) {
  return yaml_value(path, map, key, "the camera");
}

Distortion read_lens(const Path& path, const YAML::Node& node) {
  constexpr std::array<std::string_view, 1> kProjections{"pinhole"};
  yaml_choice(path, required(path, node, "camera_model"), "or unsupported camera_model", kProjections);
  constexpr std::array<std::string_view, 3> kModels{"radtan", "equidistant", "none"};
  const YAML::Node model = required(path, node, "distortion_model");
  const std::string name = yaml_choice(path, model, "or unsupported distortion_model", kModels);
  if (name == "none") return BrownConrady{};
  const YAML::Node list = required(path, node, "distortion_coeffs");
  const auto k = yaml_numbers(path, list, 4, "[-0.28, 0.07, 0.0002, 0]");
  if (name == "equidistant") return fisheye_from(path, yaml_line(list), k);
  return distortion_from(path, yaml_line(list), k);
}

// T_cn_cnm1 maps points of the camera before into this one.
Eigen::Isometry3d read_step(const Path& path, const YAML::Node& node) {
  const std::vector<double> T = yaml_all_numbers(path, node);
  const bool shaped = T.size() == 16 && T[12] == 0 && T[13] == 0 && T[14] == 0 && T[15] == 1;
  if (!shaped) throw InputError(path, yaml_line(node), "is no pose", "a 4x4 matrix [R t; 0 0 0 1] is wanted");
  const double R[] = {T[0], T[1], T[2], T[4], T[5], T[6], T[8], T[9], T[10]};
  const double t[] = {T[3], T[7], T[11]};
  return pose_from(path, yaml_line(node), R, t);
}

CameraRecord read_kalibr_camera(const Path& path, const YAML::Node& node, const std::string& name) {
  require_yaml_map(path, node, "{camera_model: pinhole, intrinsics: [fu, fv, pu, pv], ...}");
  CameraRecord record;
  record.name = name;
  record.line = yaml_line(node);
  Camera& c = record.camera;
  c.distortion = read_lens(path, node);
  const YAML::Node list = required(path, node, "intrinsics"), resolution = required(path, node, "resolution");
  const auto k = yaml_numbers(path, list, 4, "[fu, fv, pu, pv]");
  c.fx = k[0];
  c.fy = k[1];
  c.cx = k[2];
  c.cy = k[3];
  for (const char* key : {"fx", "fy", "cx", "cy"}) record.lines[key] = yaml_line(list);
  yaml_numbers(path, resolution, 2, "[640, 480]");
  c.width = parse_size(path, yaml_line(resolution), resolution[0].Scalar());
  c.height = parse_size(path, yaml_line(resolution), resolution[1].Scalar());
  record.lines["image"] = yaml_line(resolution);
  return record;
}

std::string format_lens(const Distortion& distortion) {
  if (is_pinhole(distortion)) return "  distortion_model: none\n  distortion_coeffs: []\n";
  const char* model = std::holds_alternative<Fisheye>(distortion) ? "equidistant" : "radtan";
  const DistortionCoefficients k = coefficients(distortion);
  return fmt::format("  distortion_model: {}\n  distortion_coeffs: [{}, {}, {}, {}]\n", model, k[0], k[1], k[2], k[3]);
}

std::string format_step(const Eigen::Matrix4d& T) {
  std::string text = "  T_cn_cnm1:\n";
  for (int i = 0; i < 4; ++i) {
    text += fmt::format("  - [{}, {}, {}, {}]\n", T(i, 0), T(i, 1), T(i, 2), T(i, 3));
  }
  return text;
}

}  // namespace

CameraRecords read_kalibr_chain(const Path& path, const YAML::Node& root) {
  CameraRecords records;
  double first_shift_s = 0;
  for (std::size_t i = 0; root[fmt::format("cam{}", i)]; ++i) {
    const std::string name = fmt::format("cam{}", i);
    const YAML::Node node = root[name];
    CameraRecord record = read_kalibr_camera(path, node, name);
    if (i > 0) {
      const Eigen::Isometry3d T_camera_previous = read_step(path, required(path, node, "T_cn_cnm1"));
      record.T_rig_camera = records.back().T_rig_camera * T_camera_previous.inverse();
    }
    // Of cameras with an IMU: t_imu = t_camera + shift. The rig's clock is the first camera's.
    const YAML::Node shift = node["timeshift_cam_imu"];
    const double shift_s = shift ? yaml_number(path, shift) : 0.0;
    if (i == 0) first_shift_s = shift_s;
    record.clock_offset_s = shift_s - first_shift_s;
    records.push_back(record);
  }
  return records;
}

std::string format_kalibr_chain(const CameraRig& rig) {
  std::string text;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const Camera& c = rig.cameras[i].camera;
    text += fmt::format("cam{}:\n", i);
    if (i > 0) {
      text += format_step((rig.cameras[i].T_rig_camera.inverse() * rig.cameras[i - 1].T_rig_camera).matrix());
    }
    text += "  camera_model: pinhole\n" + format_lens(c.distortion);
    text += fmt::format("  intrinsics: [{}, {}, {}, {}]\n  resolution: [{}, {}]\n  rostopic: /cam{}/image_raw\n", c.fx,
                        c.fy, c.cx, c.cy, c.width, c.height, i);
  }
  return text;
}

}  // namespace alidade
