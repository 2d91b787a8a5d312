// SPDX-License-Identifier: Apache-2.0
#include "camera/camera.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace alidade {
namespace {

struct Distorted {
  Eigen::Vector2d xy;
  Eigen::Matrix2d J;  // ∂distorted/∂undistorted
};

Distorted distort(const BrownConrady& k, const Eigen::Vector2d& xy) {
  const double x = xy.x(), y = xy.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k.k1 + r2 * (k.k2 + r2 * k.k3));
  const double slope = 2.0 * (k.k1 + r2 * (2.0 * k.k2 + r2 * 3.0 * k.k3));  // ∂radial/∂x = slope x
  Distorted d;
  d.xy = {x * radial + 2.0 * k.p1 * x * y + k.p2 * (r2 + 2.0 * x * x),
          y * radial + 2.0 * k.p2 * x * y + k.p1 * (r2 + 2.0 * y * y)};
  const double cross = slope * x * y + 2.0 * k.p1 * x + 2.0 * k.p2 * y;
  d.J << radial + slope * x * x + 2.0 * k.p1 * y + 6.0 * k.p2 * x, cross, cross,
      radial + slope * y * y + 2.0 * k.p2 * x + 6.0 * k.p1 * y;
  return d;
}

// Beyond the first radius where the radial polynomial stops growing, two directions share a pixel. Its slope
// 1 + a s + b s² + c s³ (s = r²) is least at the end of [0, r2] or where 3c s² + 2b s + a = 0.
bool folds_back(const BrownConrady& k, double r2) {
  const double a = 3.0 * k.k1, b = 5.0 * k.k2, c = 7.0 * k.k3;
  const auto grows_at = [&](double s) { return 1.0 + s * (a + s * (b + s * c)) > 0; };
  if (!grows_at(r2)) return true;
  const double discriminant = b * b - 3.0 * a * c;
  if (discriminant < 0) return false;
  // The minimum of the cubic, in the form that does not cancel; c = 0 leaves a parabola.
  const double root = std::sqrt(discriminant);
  const double least = b + root > 0 ? -a / (b + root) : (c != 0 ? (root - b) / (3.0 * c) : 0.0);
  return least > 0 && least < r2 && !grows_at(least);
}

}  // namespace

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
  const auto& k = c.distortion;
  for (double value : {k.k1, k.k2, k.p1, k.p2, k.k3}) {
    if (!std::isfinite(value)) return fmt::format("distortion must be finite, got {}", value);
  }
  return std::nullopt;
}

std::optional<Projection> project(const Camera& camera, const Eigen::Vector3d& p) {
  if (!(p.z() > 1e-9)) return std::nullopt;
  const Eigen::Vector2d xy = p.head<2>() / p.z();
  Eigen::Matrix<double, 2, 3> J_xy_point;
  J_xy_point << 1, 0, -xy.x(), 0, 1, -xy.y();
  J_xy_point /= p.z();
  const Eigen::Vector2d f(camera.fx, camera.fy);
  const Eigen::Vector2d c(camera.cx, camera.cy);
  if (camera.distortion == BrownConrady{}) return Projection{f.cwiseProduct(xy) + c, f.asDiagonal() * J_xy_point};
  if (folds_back(camera.distortion, xy.squaredNorm())) return std::nullopt;
  const Distorted d = distort(camera.distortion, xy);
  return Projection{f.cwiseProduct(d.xy) + c, f.asDiagonal() * d.J * J_xy_point};
}

std::optional<Eigen::Vector2d> undistort(const Camera& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d target((pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy);
  if (camera.distortion == BrownConrady{}) return target;
  Eigen::Vector2d xy = target;
  for (int i = 0; i < 20; ++i) {
    const Distorted d = distort(camera.distortion, xy);
    const Eigen::Vector2d error = target - d.xy;
    if (error.squaredNorm() < 1e-24) break;
    const double determinant = d.J.determinant();
    if (!(std::abs(determinant) > 1e-6)) return std::nullopt;
    Eigen::Vector2d step = d.J.inverse() * error;
    const double longest = 0.3;  // a Newton step beyond it has left the basin of the image
    if (step.norm() > longest) step *= longest / step.norm();
    xy += step;
  }
  if ((distort(camera.distortion, xy).xy - target).norm() > 1e-9) return std::nullopt;
  if (folds_back(camera.distortion, xy.squaredNorm())) return std::nullopt;
  return xy;
}

std::optional<Eigen::Vector3d> unproject(const Camera& camera, const Eigen::Vector2d& pixel) {
  const auto xy = undistort(camera, pixel);
  if (!xy) return std::nullopt;
  return xy->homogeneous().normalized();
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
