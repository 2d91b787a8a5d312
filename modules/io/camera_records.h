// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "camera/camera_rig.h"
#include "io/camera_file.h"
#include "io/text_lines.h"

// The formats behind camera_file.h. Each reader takes the content of the file and throws InputError for what it cannot
// read; whether the camera is possible is judged once for all of them, in camera_file.cpp.
namespace alidade {

/// What a file says of one camera; its size is 0×0 where the file does not say.
struct CameraRecord : RigCamera {
  int line = 0;                      ///< where the camera stands
  std::map<std::string, int> lines;  ///< where "fx", "fy", "cx", "cy", "image" (the size), "distortion" stand, if known
};
using CameraRecords = std::vector<CameraRecord>;

/// The cameras of a file of any format, in its order, all of a size and possible. Throws as read_cameras.
CameraRecords read_camera_records(const std::filesystem::path& path, std::optional<ImageSize> size_of_images);

/// Our YAML, OpenCV's, ROS' and Kalibr's.
CameraRecords parse_camera_yaml(const std::filesystem::path& path, const std::string& text);

/// OpenCV's XML.
CameraRecords parse_opencv_xml(const std::filesystem::path& path, const std::string& text);

/// COLMAP's cameras.txt; the names are its CAMERA_IDs.
CameraRecords parse_colmap_cameras(const std::filesystem::path& path, const std::vector<TextLine>& lines);

/// mrcal's .cameramodel; the name is the file's.
CameraRecords parse_mrcal_model(const std::filesystem::path& path, const std::string& text);

/// Pairs of a name and a value: "fx 500 fy 500 cx 320 cy 240".
CameraRecords parse_camera_words(const std::filesystem::path& path, const std::vector<TextLine>& lines);

/// KITTI's calib.txt: 3×4 projection matrices, "P0: ..." or bare.
CameraRecords parse_kitti_calibration(const std::filesystem::path& path, const std::vector<TextLine>& lines);

/// Strecha's *.camera (K, distortion, R, C, size), or K alone.
CameraRecords parse_camera_matrix(const std::filesystem::path& path, const std::vector<TextLine>& lines);

/// Sets fx, fy, cx, cy from the nine numbers of K, row by row. Throws InputError where it is none.
void set_intrinsics(const std::filesystem::path& path, int line, std::span<const double> K, Camera& camera);

/// T of the nine numbers of R, row by row, and t (m). Throws InputError where R is no rotation.
Eigen::Isometry3d pose_from(const std::filesystem::path& path, int line, std::span<const double> R,
                            std::span<const double> t);

/// A width or height in px, 0 to 1 000 000.
int parse_size(const std::filesystem::path& path, int line, std::string_view word);

/// Distortion of OpenCV's order k1 k2 p1 p2 [k3 [k4 k5 k6 ...]]. Throws InputError where thin-prism or tilt
/// coefficients beyond k6 are not 0.
Distortion distortion_from(const std::filesystem::path& path, int line, std::span<const double> coefficients);

/// Fisheye of four coefficients. Throws InputError for another number of them.
Fisheye fisheye_from(const std::filesystem::path& path, int line, std::span<const double> coefficients);

/// A text in YAML's double quotes.
std::string quoted_yaml(const std::string& text);

/// The lines of our YAML that say a camera's model and numbers, each after `indent`.
std::string format_camera(const Camera& camera, const std::string& indent);

/// The same, with its pose, covariances and clock where they are known.
std::string format_rig_camera(const RigCamera& camera, const std::string& indent);

// The writers behind format_cameras (camera_formats.h), for rigs that each format can hold.
std::string format_opencv_cameras(const CameraRig& rig);
std::string format_ros_camera(const RigCamera& camera);
std::string format_kalibr_chain(const CameraRig& rig);
std::string format_mrcal_model(const RigCamera& camera);

/// A camera per line of COLMAP's cameras.txt, CAMERA_IDs from 1.
std::string format_colmap_cameras(std::span<const Camera> cameras);

}  // namespace alidade
