// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <opencv2/core/mat.hpp>

#include "camera/camera.h"

namespace alidade {

/// What the pinhole camera of undistorted images shows.
struct UndistortionOptions {
  /// 0: only what the lens saw, no black border; 1: all that the lens saw; between them, in proportion. As alpha of
  /// OpenCV's getOptimalNewCameraMatrix.
  double alpha = 0;
  /// Focal length of the new camera, px, its principal point in the middle, whatever alpha; 0: by alpha. For lenses
  /// that see so wide that no pinhole image holds all of it.
  double focal_px = 0;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const UndistortionOptions& options);

/// The pinhole camera without distortion that images of `camera` are undistorted for: of the same size, its readout
/// carried on (the rows of an undistorted image are those of the sensor only nearly). With alpha 0 every pixel of its
/// image shows something. Empty where alpha > 0 and some pixel at the border of `camera` looks 80° or more off axis, or
/// has no ray. Throws std::invalid_argument for an impossible camera or options.
std::optional<Camera> undistorted_camera(const Camera& camera, const UndistortionOptions& options = {});

/// Where the pixels of an undistorted image come from.
struct UndistortionMap {
  cv::Mat source_px;  ///< CV_32FC2 of the new size: the pixel (x, y) of the lens' image; (0, 0) where it saw nothing
  cv::Mat is_seen;    ///< CV_8U, 255 where the lens saw it, else 0
};

/// The map from images of `camera` to those of `pinhole`, by project(): for every lens model.
UndistortionMap undistortion_map(const Camera& camera, const Camera& pinhole);

/// The image (8 bits, grey or BGR, of the camera's size) without distortion, interpolated by Lanczos' kernel over 8×8
/// pixels; black where the lens saw nothing.
cv::Mat undistorted_image(const cv::Mat& image, const UndistortionMap& map);

}  // namespace alidade
