// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

namespace alidade {

/// Lens distortion of Brown and Conrady, OpenCV's order and signs; all zero: none.
/// x_d = x (1 + k1 r² + k2 r⁴ + k3 r⁶) + 2 p1 x y + p2 (r² + 2x²), and y alike with p1 and p2 exchanged.
struct BrownConrady {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
  bool operator==(const BrownConrady&) const = default;
};

/// Intrinsics of a pinhole camera: x right, y down, z forward; pixel (0, 0) is the centre of the top-left pixel.
struct Camera {
  int width = 0, height = 0;  ///< px
  double fx = 0, fy = 0;      ///< px
  double cx = 0, cy = 0;      ///< px
  BrownConrady distortion;
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
/// camera, or so far off axis that the distortion polynomial folds back. The pixel may lie outside the image.
std::optional<Projection> project(const Camera& camera, const Eigen::Vector3d& p_camera);

/// The undistorted normalised coordinates (x/z, y/z) that project to `pixel`, by damped Newton steps.
/// Empty where the distortion has no inverse there.
std::optional<Eigen::Vector2d> undistort(const Camera& camera, const Eigen::Vector2d& pixel);

/// The unit direction d_camera of the ray through `pixel`; empty as for undistort.
std::optional<Eigen::Vector3d> unproject(const Camera& camera, const Eigen::Vector2d& pixel);

/// K, the 3×3 calibration matrix (px).
Eigen::Matrix3d calibration_matrix(const Camera& camera);

/// Whether `pixel` lies in the image, at least `margin_px` from its border.
bool is_inside(const Camera& camera, const Eigen::Vector2d& pixel, double margin_px = 0.0);

/// The camera of images resized by `factor` about their corner: pixel centres keep their meaning, c' = (c + ½) f − ½.
Camera resized(const Camera& camera, double factor);

}  // namespace alidade
