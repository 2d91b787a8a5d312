// SPDX-License-Identifier: Apache-2.0
#include "io/camera_formats.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/camera_records.h"
#include "io/rig_file.h"

namespace alidade {
namespace {

bool is_fisheye(const RigCamera& c) {
  return std::holds_alternative<Fisheye>(c.camera.distortion);
}

// What the format says of lenses that it does not have; empty for those that it has.
std::optional<std::string> find_lens_obstacle(CameraFormat format, const RigCamera& c) {
  if (format == CameraFormat::Mrcal && is_fisheye(c)) return "mrcal has no model of this fisheye lens";
  const auto* lens = std::get_if<BrownConrady>(&c.camera.distortion);
  if (format != CameraFormat::Kalibr || !lens) return std::nullopt;
  if (lens->k4 != 0 || lens->k5 != 0 || lens->k6 != 0) return "Kalibr has no rational distortion (k4, k5, k6)";
  if (lens->k3 != 0) return "Kalibr's radtan has no k3";
  return std::nullopt;
}

std::optional<std::string> find_opencv_obstacle(const CameraRig& rig) {
  const auto& cameras = rig.cameras;
  if (cameras.size() > 2) return fmt::format("OpenCV's file holds one camera or two, not {}", cameras.size());
  if (cameras.size() < 2) return std::nullopt;
  const Camera &a = cameras[0].camera, &b = cameras[1].camera;
  if (a.width != b.width || a.height != b.height) return "OpenCV's stereo file has one image size for both cameras";
  if (is_fisheye(cameras[0]) != is_fisheye(cameras[1])) return "OpenCV's stereo file has one lens model for both";
  return std::nullopt;
}

bool is_posed(const RigCamera& c) {
  return c.T_rig_camera.matrix() != Eigen::Isometry3d::Identity().matrix();
}

std::optional<std::string> find_lost_pose(CameraFormat format, const CameraRig& rig) {
  const bool keeps_poses = format == CameraFormat::Mrcal;
  if (keeps_poses || std::none_of(rig.cameras.begin(), rig.cameras.end(), is_posed)) return std::nullopt;
  const bool relative = (format == CameraFormat::OpenCv || format == CameraFormat::Kalibr) && rig.cameras.size() > 1;
  if (!relative) return "poses on the rig";
  if (!is_posed(rig.cameras.front())) return std::nullopt;
  return fmt::format("the rig's frame (camera '{}' takes its place)", rig.cameras.front().name);
}

}  // namespace

const char* to_string(CameraFormat format) {
  switch (format) {
    case CameraFormat::Alidade:
      return "alidade";
    case CameraFormat::OpenCv:
      return "opencv";
    case CameraFormat::Ros:
      return "ros";
    case CameraFormat::Kalibr:
      return "kalibr";
    case CameraFormat::Colmap:
      return "colmap";
    case CameraFormat::Mrcal:
      return "mrcal";
  }
  throw std::invalid_argument("to_string: no such CameraFormat");
}

std::optional<std::string> find_obstacle(CameraFormat format, const CameraRig& rig) {
  if (rig.cameras.empty()) return "there is no camera";
  if (format == CameraFormat::OpenCv) return find_opencv_obstacle(rig);
  const bool holds_one = format == CameraFormat::Ros || format == CameraFormat::Mrcal;
  if (holds_one && rig.cameras.size() > 1) {
    return fmt::format("a file of format {} holds one camera, not {}", to_string(format), rig.cameras.size());
  }
  std::set<std::string> names;
  for (const RigCamera& c : rig.cameras) {
    if (const auto obstacle = find_lens_obstacle(format, c)) return fmt::format("{} (camera '{}')", *obstacle, c.name);
    const bool taken = !names.insert(c.name).second;
    if (format == CameraFormat::Alidade && taken) return fmt::format("two cameras are named '{}'", c.name);
  }
  return std::nullopt;
}

std::vector<std::string> list_losses(CameraFormat format, const CameraRig& rig) {
  if (format == CameraFormat::Alidade) return {};
  const auto any = [&](auto has) { return std::any_of(rig.cameras.begin(), rig.cameras.end(), has); };
  std::vector<std::string> losses;
  if (any([](const RigCamera& c) { return c.intrinsics_covariance || c.pose_covariance; })) {
    losses.emplace_back("covariances");
  }
  if (any([](const RigCamera& c) { return c.clock_offset_s != 0; })) losses.emplace_back("clock offsets");
  if (any([](const RigCamera& c) { return c.camera.readout_s != 0; })) losses.emplace_back("read-out times");
  if (const auto pose = find_lost_pose(format, rig)) losses.push_back(*pose);
  return losses;
}

std::string format_cameras(CameraFormat format, const CameraRig& rig) {
  if (const auto obstacle = find_obstacle(format, rig)) throw std::invalid_argument("format_cameras: " + *obstacle);
  switch (format) {
    case CameraFormat::Alidade:
      return format_camera_rig(rig);
    case CameraFormat::OpenCv:
      return format_opencv_cameras(rig);
    case CameraFormat::Ros:
      return format_ros_camera(rig.cameras.front());
    case CameraFormat::Kalibr:
      return format_kalibr_chain(rig);
    case CameraFormat::Mrcal:
      return format_mrcal_model(rig.cameras.front());
    case CameraFormat::Colmap:
      break;
  }
  std::vector<Camera> cameras;
  for (const RigCamera& c : rig.cameras) cameras.push_back(c.camera);
  return format_colmap_cameras(cameras);
}

void write_cameras_as(const std::filesystem::path& path, CameraFormat format, const CameraRig& rig) {
  if (const auto obstacle = find_obstacle(format, rig)) {
    throw InputError(path, 0, fmt::format("cannot be written: {}", *obstacle),
                     "choose another format, or one of the cameras, or calibrate with a lens model that it has");
  }
  write_file(path, format_cameras(format, rig));
}

}  // namespace alidade
