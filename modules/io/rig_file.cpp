// SPDX-License-Identifier: Apache-2.0
#include "io/rig_file.h"

#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/camera_file.h"
#include "io/camera_records.h"
#include "io/pose_yaml.h"

namespace alidade {
namespace {

constexpr const char* kHead =
    "# pixel (0, 0) is the centre of the top-left pixel; distortion in OpenCV's order and signs\n";
constexpr const char* kRigHead =
    "# T_rig_camera maps points of the camera into the rig; quaternions in the order w, x, y, z; covariances: upper\n"
    "# triangles by rows, of a pose that of its right perturbation (translation, rotation), m2, m rad, rad2\n";

std::string_view model_name(const Distortion& distortion) {
  if (std::holds_alternative<Fisheye>(distortion)) return "fisheye";
  return is_pinhole(distortion) ? "pinhole" : "brown_conrady";
}

// "k1: -0.26, k2: 0.1, ..."; Brown and Conrady's k4, k5, k6 only where they are used.
std::string format_coefficients(const Distortion& distortion) {
  const DistortionCoefficients values = coefficients(distortion);
  const auto names = coefficient_names(distortion);
  Eigen::Index count = values.size();
  while (count > 5 && values[count - 1] == 0) --count;
  std::string text;
  for (Eigen::Index i = 0; i < count; ++i) {
    text += fmt::format("{}{}: {}", i == 0 ? "" : ", ", names[static_cast<std::size_t>(i)], values[i]);
  }
  return text;
}

// Parameters without variance were held: they are left out.
std::string format_intrinsics_covariance(const RigCamera& c, const std::string& indent) {
  const std::vector<std::string> names = intrinsics_names(c.camera);
  const Eigen::MatrixXd& C = *c.intrinsics_covariance;
  const auto count = static_cast<Eigen::Index>(names.size());
  if (C.rows() != count || C.cols() != count) throw std::invalid_argument("intrinsics_covariance of another model");
  std::vector<Eigen::Index> free;
  std::vector<std::string> free_names;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (C(i, i) == 0) continue;
    free.push_back(i);
    free_names.push_back(names[static_cast<std::size_t>(i)]);
  }
  if (free.empty()) return "";
  return fmt::format("{}intrinsics_covariance:\n{}  parameters: [{}]\n{}  covariance: {}\n", indent, indent,
                     fmt::join(free_names, ", "), indent, format_covariance(C(free, free)));
}

bool is_on_rig(const RigCamera& c) {
  return c.pose_covariance || c.T_rig_camera.matrix() != Eigen::Isometry3d::Identity().matrix();
}

}  // namespace

std::string quoted_yaml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return quoted + '"';
}

std::string format_camera(const Camera& c, const std::string& indent) {
  std::string text = fmt::format("{}model: {}\n{}resolution_px: [{}, {}]\n", indent, model_name(c.distortion), indent,
                                 c.width, c.height);
  text += fmt::format("{}intrinsics_px: {{fx: {}, fy: {}, cx: {}, cy: {}}}\n", indent, c.fx, c.fy, c.cx, c.cy);
  if (!is_pinhole(c.distortion)) {
    text += fmt::format("{}distortion: {{{}}}\n", indent, format_coefficients(c.distortion));
  }
  if (c.readout_s != 0) text += fmt::format("{}readout_s: {}\n", indent, c.readout_s);
  return text;
}

std::string format_rig_camera(const RigCamera& c, const std::string& indent) {
  std::string text = format_camera(c.camera, indent);
  if (c.intrinsics_covariance) text += format_intrinsics_covariance(c, indent);
  if (is_on_rig(c)) text += fmt::format("{}T_rig_camera: {}\n", indent, format_pose(c.T_rig_camera));
  if (c.pose_covariance) text += fmt::format("{}pose_covariance: {}\n", indent, format_covariance(*c.pose_covariance));
  if (c.clock_offset_s != 0) text += fmt::format("{}clock_offset_s: {}\n", indent, c.clock_offset_s);
  return text;
}

std::string format_camera_rig(const CameraRig& rig) {
  if (rig.cameras.empty()) throw std::invalid_argument("format_camera_rig: a rig without cameras");
  std::string text = std::string(kHead) + kRigHead;
  if (rig.cameras.size() == 1) {
    const RigCamera& camera = rig.cameras.front();
    return text + fmt::format("camera:\n  name: {}\n", quoted_yaml(camera.name)) + format_rig_camera(camera, "  ");
  }
  std::set<std::string> names;
  text += "cameras:\n";
  for (const RigCamera& camera : rig.cameras) {
    if (!names.insert(camera.name).second) {
      throw std::invalid_argument("format_camera_rig: two cameras are named " + camera.name);
    }
    text += fmt::format("  - name: {}\n", quoted_yaml(camera.name)) + format_rig_camera(camera, "    ");
  }
  return text;
}

void write_camera_rig(const std::filesystem::path& path, const CameraRig& rig) {
  write_file(path, format_camera_rig(rig));
}

CameraRig read_camera_rig(const std::filesystem::path& path, std::optional<ImageSize> size_of_images) {
  CameraRig rig;
  for (const CameraRecord& record : read_camera_records(path, size_of_images)) rig.cameras.push_back(record);
  return rig;
}

void write_camera(const std::filesystem::path& path, const Camera& camera, const std::string& name) {
  const std::string text = kHead + fmt::format("camera:\n  name: {}\n", quoted_yaml(name));
  write_file(path, text + format_camera(camera, "  "));
}

}  // namespace alidade
