// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include <Eigen/Core>

namespace alidade {

/// Lens distortion of Brown and Conrady with OpenCV's rational denominator, in its order and signs; all zero: none.
/// x_d = x (1 + k1 r² + k2 r⁴ + k3 r⁶) / (1 + k4 r² + k5 r⁴ + k6 r⁶) + 2 p1 x y + p2 (r² + 2x²), and y alike with p1
/// and p2 exchanged; x = X/Z.
struct BrownConrady {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0, k4 = 0, k5 = 0, k6 = 0;
  bool operator==(const BrownConrady&) const = default;
};

/// Fisheye lens whose image radius grows with the angle θ off axis: θ_d = θ (1 + k1 θ² + k2 θ⁴ + k3 θ⁶ + k4 θ⁸),
/// OpenCV's fisheye, ROS' "equidistant". Source: Kannala and Brandt 2006. All zero: radius proportional to angle.
struct Fisheye {
  double k1 = 0, k2 = 0, k3 = 0, k4 = 0;
  bool operator==(const Fisheye&) const = default;
};

using Distortion = std::variant<BrownConrady, Fisheye>;

/// The most coefficients of any model.
inline constexpr int kMostCoefficients = 8;
using DistortionCoefficients = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostCoefficients, 1>;

/// The coefficients of a model in OpenCV's order: k1 k2 p1 p2 k3 k4 k5 k6, or k1 k2 k3 k4 of a fisheye.
DistortionCoefficients coefficients(const Distortion& distortion);

/// Their names, in the same order.
std::span<const std::string_view> coefficient_names(const Distortion& distortion);

/// The same model with other coefficients; the ones that `values` leaves out are 0.
/// Throws std::invalid_argument for more values than the model has.
Distortion with_coefficients(const Distortion& model, std::span<const double> values);

/// Whether points are imaged as by a pinhole.
bool is_pinhole(const Distortion& distortion);

/// A point's place on the image plane at focal length 1, and how it moves.
struct DistortedPoint {
  Eigen::Vector2d xy;
  Eigen::Matrix<double, 2, 3> J_xy_point;  ///< 1/m
};

/// Where p_camera (m) is imaged at focal length 1, by the formula alone: beyond the fold of the polynomial (see
/// folds_back) the place means nothing. Brown and Conrady's model wants z > 0, a fisheye any point off its backward
/// axis.
DistortedPoint distort(const Distortion& distortion, const Eigen::Vector3d& p_camera);

/// ∂xy/∂coefficients at p_camera, 2×n in the order of coefficients().
Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMostCoefficients> coefficient_jacobian(const Distortion& distortion,
                                                                                       const Eigen::Vector3d& p_camera);

/// Whether the radius on the image plane has stopped growing at p_camera's angle or before it: two directions share a
/// pixel there, and the model has no meaning.
bool folds_back(const Distortion& distortion, const Eigen::Vector3d& p_camera);

/// The unit direction d_camera that is imaged at `xy` (focal length 1), by damped Newton steps; empty where none is.
std::optional<Eigen::Vector3d> undistorted_direction(const Distortion& distortion, const Eigen::Vector2d& xy);

}  // namespace alidade
