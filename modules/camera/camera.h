// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "camera/distortion.h"

namespace alidade {

/// Intrinsics of a camera: x right, y down, z forward; pixel (0, 0) is the centre of the top-left pixel.
struct Camera {
  int width = 0, height = 0;  ///< px
  double fx = 0, fy = 0;      ///< px
  double cx = 0, cy = 0;      ///< px
  Distortion distortion;
  double readout_s = 0;  ///< from the first row's exposure to the last one's; 0: all rows are exposed at once
  bool operator==(const Camera&) const = default;
};

/// Says what is impossible about a camera ("fx must be > 0 px, got -3.1"); empty where nothing is.
std::optional<std::string> find_fault(const Camera& camera);

/// A pixel and how it moves with the point that it shows.
struct Projection {
  Eigen::Vector2d pixel;                      ///< px
  Eigen::Matrix<double, 2, 3> J_pixel_point;  ///< ∂pixel/∂p_camera, px/m
};

/// The pixel of a point in camera coordinates (m) and its Jacobian. Empty where the point is not in front of the
/// camera (a fisheye sees all but the backward axis), or so far off axis that the distortion polynomial folds back. The
/// pixel may lie outside the image.
std::optional<Projection> project(const Camera& camera, const Eigen::Vector3d& p_camera);

/// The undistorted normalised coordinates (x/z, y/z) that project to `pixel`, by damped Newton steps.
/// Empty where the distortion has no inverse there, or the ray does not go forward.
std::optional<Eigen::Vector2d> undistort(const Camera& camera, const Eigen::Vector2d& pixel);

/// The unit direction d_camera of the ray through `pixel`; empty where the distortion has no inverse there.
std::optional<Eigen::Vector3d> unproject(const Camera& camera, const Eigen::Vector2d& pixel);

/// fx, fy, cx, cy, then the distortion's coefficients: all that a calibration finds.
using Intrinsics = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4 + kMostCoefficients, 1>;
Intrinsics intrinsics(const Camera& camera);

/// The names of intrinsics() in order: "fx", "fy", "cx", "cy", "k1", ...
std::vector<std::string> intrinsics_names(const Camera& camera);

/// The camera with other intrinsics of the same model. Throws std::invalid_argument for another number of them.
Camera with_intrinsics(Camera camera, const Intrinsics& values);

/// ∂pixel/∂intrinsics of a point in camera coordinates, 2×n (px per unit of each), by the formula alone as distort.
Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 4 + kMostCoefficients> intrinsics_jacobian(
    const Camera& camera, const Eigen::Vector3d& p_camera);

/// K, the 3×3 calibration matrix (px).
Eigen::Matrix3d calibration_matrix(const Camera& camera);

/// Whether `pixel` lies in the image, at least `margin_px` from its border.
bool is_inside(const Camera& camera, const Eigen::Vector2d& pixel, double margin_px = 0.0);

/// The camera of images resized by `factor` about their corner: pixel centres keep their meaning, c' = (c + ½) f − ½.
Camera resized(const Camera& camera, double factor);

}  // namespace alidade
