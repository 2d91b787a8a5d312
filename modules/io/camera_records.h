// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "camera/camera.h"
#include "io/text_lines.h"

// The formats behind camera_file.h. Each reader takes the content of the file and throws InputError for what it cannot
// read; whether the camera is possible is judged once for all of them, in camera_file.cpp.
namespace alidade {

/// What a file says of one camera; its size is 0×0 where the file does not say.
struct CameraRecord {
  std::string name;
  Camera camera;
  int line = 0;                      ///< where the camera stands
  std::map<std::string, int> lines;  ///< where "fx", "fy", "cx", "cy", "image" (the size), "distortion" stand, if known
};
using CameraRecords = std::vector<CameraRecord>;

/// Our YAML, OpenCV's and ROS'.
CameraRecords parse_camera_yaml(const std::filesystem::path& path, const std::string& text);

/// OpenCV's XML.
CameraRecords parse_opencv_xml(const std::filesystem::path& path, const std::string& text);

/// COLMAP's cameras.txt; the names are its CAMERA_IDs.
CameraRecords parse_colmap_cameras(const std::filesystem::path& path, const std::vector<TextLine>& lines);

/// Pairs of a name and a value: "fx 500 fy 500 cx 320 cy 240".
CameraRecords parse_camera_words(const std::filesystem::path& path, const std::vector<TextLine>& lines);

/// KITTI's calib.txt: 3×4 projection matrices, "P0: ..." or bare.
CameraRecords parse_kitti_calibration(const std::filesystem::path& path, const std::vector<TextLine>& lines);

/// Strecha's *.camera (K, distortion, R, C, size), or K alone.
CameraRecords parse_camera_matrix(const std::filesystem::path& path, const std::vector<TextLine>& lines);

/// Sets fx, fy, cx, cy from the nine numbers of K, row by row. Throws InputError where it is none.
void set_intrinsics(const std::filesystem::path& path, int line, std::span<const double> K, Camera& camera);

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

}  // namespace alidade
