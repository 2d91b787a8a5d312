// SPDX-License-Identifier: Apache-2.0
#include "camera/camera.h"

#include <cmath>
#include <span>
#include <stdexcept>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace alidade {
std::optional<std::string> find_fault(const Camera& camera) {
  const auto& c = camera;
  if (c.width <= 0 || c.height <= 0) return fmt::format("image size must be > 0 px, got {}x{}", c.width, c.height);
  if (!(c.fx > 0) || !std::isfinite(c.fx)) return fmt::format("fx must be > 0 px, got {}", c.fx);
  if (!(c.fy > 0) || !std::isfinite(c.fy)) return fmt::format("fy must be > 0 px, got {}", c.fy);
  if (!(c.cx > -0.5 && c.cx < c.width))
    return fmt::format("cx must lie in the image (0..{} px), got {}", c.width, c.cx);
  if (!(c.cy > -0.5 && c.cy < c.height)) {
    return fmt::format("cy must lie in the image (0..{} px), got {}", c.height, c.cy);
  }
  if (!(c.readout_s >= 0 && c.readout_s < 1)) return fmt::format("readout_s must lie in [0, 1) s, got {}", c.readout_s);
  for (const double value : coefficients(c.distortion)) {
    if (!std::isfinite(value)) return fmt::format("distortion must be finite, got {}", value);
  }
  return std::nullopt;
}

std::optional<Projection> project(const Camera& camera, const Eigen::Vector3d& p) {
  const Eigen::Vector2d f(camera.fx, camera.fy);
  const Eigen::Vector2d c(camera.cx, camera.cy);
  const bool is_seen =
      std::holds_alternative<Fisheye>(camera.distortion) ? p.z() > -p.head<2>().norm() * 1e3 : p.z() > 1e-9;
  if (!is_seen) return std::nullopt;
  if (is_pinhole(camera.distortion)) {
    const Eigen::Vector2d xy = p.head<2>() / p.z();
    Eigen::Matrix<double, 2, 3> J_xy_point;
    J_xy_point << 1, 0, -xy.x(), 0, 1, -xy.y();
    J_xy_point /= p.z();
    return Projection{f.cwiseProduct(xy) + c, f.asDiagonal() * J_xy_point};
  }
  if (folds_back(camera.distortion, p)) return std::nullopt;
  const DistortedPoint d = distort(camera.distortion, p);
  return Projection{f.cwiseProduct(d.xy) + c, f.asDiagonal() * d.J_xy_point};
}

std::optional<Eigen::Vector2d> undistort(const Camera& camera, const Eigen::Vector2d& pixel) {
  const auto direction = unproject(camera, pixel);
  if (!direction || !(direction->z() > 1e-9)) return std::nullopt;
  return direction->head<2>() / direction->z();
}

std::optional<Eigen::Vector3d> unproject(const Camera& camera, const Eigen::Vector2d& pixel) {
  return undistorted_direction(camera.distortion,
                               {(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy});
}

Intrinsics intrinsics(const Camera& camera) {
  const DistortionCoefficients k = coefficients(camera.distortion);
  Intrinsics values(4 + k.size());
  values << camera.fx, camera.fy, camera.cx, camera.cy, k;
  return values;
}

std::vector<std::string> intrinsics_names(const Camera& camera) {
  std::vector<std::string> names{"fx", "fy", "cx", "cy"};
  for (const std::string_view name : coefficient_names(camera.distortion)) names.emplace_back(name);
  return names;
}

Camera with_intrinsics(Camera camera, const Intrinsics& values) {
  if (values.size() != intrinsics(camera).size()) throw std::invalid_argument("intrinsics of another model");
  camera.fx = values[0];
  camera.fy = values[1];
  camera.cx = values[2];
  camera.cy = values[3];
  const auto k = std::span(values.data() + 4, static_cast<std::size_t>(values.size() - 4));
  camera.distortion = with_coefficients(camera.distortion, k);
  return camera;
}

Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 4 + kMostCoefficients> intrinsics_jacobian(const Camera& camera,
                                                                                          const Eigen::Vector3d& p) {
  const Eigen::Vector2d xy = distort(camera.distortion, p).xy;
  const auto J_coefficients = coefficient_jacobian(camera.distortion, p);
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 4 + kMostCoefficients> J(2, 4 + J_coefficients.cols());
  J.leftCols<4>() << xy.x(), 0, 1, 0, 0, xy.y(), 0, 1;
  J.rightCols(J_coefficients.cols()) = Eigen::Vector2d(camera.fx, camera.fy).asDiagonal() * J_coefficients;
  return J;
}

Eigen::Matrix3d calibration_matrix(const Camera& camera) {
  Eigen::Matrix3d K;
  K << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  return K;
}

bool is_inside(const Camera& camera, const Eigen::Vector2d& pixel, double margin_px) {
  return pixel.x() >= margin_px && pixel.y() >= margin_px && pixel.x() <= camera.width - 1 - margin_px &&
         pixel.y() <= camera.height - 1 - margin_px;
}

Camera resized(const Camera& camera, double factor) {
  Camera c = camera;
  c.width = static_cast<int>(std::lround(camera.width * factor));
  c.height = static_cast<int>(std::lround(camera.height * factor));
  c.fx *= factor;
  c.fy *= factor;
  c.cx = (camera.cx + 0.5) * factor - 0.5;
  c.cy = (camera.cy + 0.5) * factor - 0.5;
  return c;
}

}  // namespace alidade
