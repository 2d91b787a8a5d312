// SPDX-License-Identifier: Apache-2.0
#include "capture/undistortion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

constexpr int kSamplesPerSide = 64;
constexpr double kWidest = 5.671;  // tan 80°: beyond it a pinhole image is nearly all border

/// On the plane z = 1 of camera coordinates.
struct Rectangle {
  Eigen::Vector2d least, most;
};

// Samples along one side of the image, the corners included.
enum class Side { Left, Right, Top, Bottom };
std::vector<Eigen::Vector2d> side_pixels(const Camera& c, Side side) {
  const double right = c.width - 1, bottom = c.height - 1;
  std::vector<Eigen::Vector2d> pixels;
  for (int i = 0; i <= kSamplesPerSide; ++i) {
    const double part = static_cast<double>(i) / kSamplesPerSide;
    switch (side) {
      case Side::Left:
        pixels.emplace_back(0, part * bottom);
        break;
      case Side::Right:
        pixels.emplace_back(right, part * bottom);
        break;
      case Side::Top:
        pixels.emplace_back(part * right, 0);
        break;
      case Side::Bottom:
        pixels.emplace_back(part * right, bottom);
        break;
    }
  }
  return pixels;
}

// The rays through a side; those that look too far off axis, or that do not exist, are left out.
std::vector<Eigen::Vector2d> side_rays(const Camera& c, Side side) {
  std::vector<Eigen::Vector2d> rays;
  for (const Eigen::Vector2d& pixel : side_pixels(c, side)) {
    const auto ray = undistort(c, pixel);
    if (ray && ray->norm() < kWidest) rays.push_back(*ray);
  }
  return rays;
}

// Whether the lens images the whole border of the rectangle inside its image.
bool is_all_seen(const Camera& camera, const Rectangle& r) {
  const Eigen::Vector2d size = r.most - r.least;
  for (int i = 0; i <= kSamplesPerSide; ++i) {
    const double part = static_cast<double>(i) / kSamplesPerSide;
    for (const Eigen::Vector2d& at :
         {Eigen::Vector2d(part, 0), Eigen::Vector2d(part, 1), Eigen::Vector2d(0, part), Eigen::Vector2d(1, part)}) {
      const Eigen::Vector2d ray = r.least + size.cwiseProduct(at);
      const auto seen = project(camera, ray.homogeneous());
      if (!seen || !is_inside(camera, seen->pixel)) return false;
    }
  }
  return true;
}

// The largest rectangle about `centre`, of the shape of the one that the sides leave inside, that the lens sees whole:
// where the corners of the image have no rays, the corners of the latter may lie beyond all that it sees.
Rectangle find_inner(const Camera& camera, const Eigen::Vector2d& centre) {
  Rectangle inside{Eigen::Vector2d::Constant(-kWidest), Eigen::Vector2d::Constant(kWidest)};
  for (const auto& ray : side_rays(camera, Side::Left)) inside.least.x() = std::max(inside.least.x(), ray.x());
  for (const auto& ray : side_rays(camera, Side::Right)) inside.most.x() = std::min(inside.most.x(), ray.x());
  for (const auto& ray : side_rays(camera, Side::Top)) inside.least.y() = std::max(inside.least.y(), ray.y());
  for (const auto& ray : side_rays(camera, Side::Bottom)) inside.most.y() = std::min(inside.most.y(), ray.y());
  const auto scaled = [&](double factor) {
    return Rectangle{centre + factor * (inside.least - centre), centre + factor * (inside.most - centre)};
  };
  if (is_all_seen(camera, scaled(1))) return scaled(1);
  double seen = 0, unseen = 1;
  for (int i = 0; i < 24; ++i) {
    const double middle = (seen + unseen) / 2;
    (is_all_seen(camera, scaled(middle)) ? seen : unseen) = middle;
  }
  return scaled(seen);
}

// The smallest rectangle with all that the lens sees; empty where that reaches too far off axis.
std::optional<Rectangle> find_outer(const Camera& camera) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Rectangle outer{Eigen::Vector2d::Constant(kInfinity), Eigen::Vector2d::Constant(-kInfinity)};
  for (const Side side : {Side::Left, Side::Right, Side::Top, Side::Bottom}) {
    const auto rays = side_rays(camera, side);
    if (rays.size() != side_pixels(camera, side).size()) return std::nullopt;
    for (const Eigen::Vector2d& ray : rays) {
      outer.least = outer.least.cwiseMin(ray);
      outer.most = outer.most.cwiseMax(ray);
    }
  }
  return outer;
}

// The camera whose outermost pixels lie on the sides of the rectangle.
Camera that_shows(const Rectangle& rectangle, Camera pinhole) {
  const Eigen::Vector2d last(pinhole.width - 1, pinhole.height - 1);
  const Eigen::Vector2d f = last.cwiseQuotient(rectangle.most - rectangle.least);
  pinhole.fx = f.x();
  pinhole.fy = f.y();
  pinhole.cx = -f.x() * rectangle.least.x();
  pinhole.cy = -f.y() * rectangle.least.y();
  return pinhole;
}

Camera pinhole_of(const Camera& camera) {
  Camera pinhole = camera;
  pinhole.distortion = BrownConrady{};
  return pinhole;
}

}  // namespace

void validate(const UndistortionOptions& options) {
  if (!(options.alpha >= 0 && options.alpha <= 1)) {
    throw std::invalid_argument(fmt::format("alpha must lie in [0, 1], got {}", options.alpha));
  }
  if (!(options.focal_px >= 0) || !std::isfinite(options.focal_px)) {
    throw std::invalid_argument(fmt::format("focal_px must be >= 0 px, got {}", options.focal_px));
  }
}

std::optional<Camera> undistorted_camera(const Camera& camera, const UndistortionOptions& options) {
  validate(options);
  if (const auto fault = find_fault(camera)) throw std::invalid_argument("undistorted_camera: " + *fault);
  Camera pinhole = pinhole_of(camera);
  const Eigen::Vector2d last(camera.width - 1, camera.height - 1);
  if (options.focal_px > 0) {
    pinhole.fx = pinhole.fy = options.focal_px;
    pinhole.cx = last.x() / 2;
    pinhole.cy = last.y() / 2;
    return pinhole;
  }
  if (is_pinhole(camera.distortion)) return pinhole;
  const auto centre = undistort(camera, last / 2);
  if (!centre) return std::nullopt;
  const Intrinsics inner = intrinsics(that_shows(find_inner(camera, *centre), pinhole));
  if (options.alpha == 0) return with_intrinsics(pinhole, inner);
  const auto rectangle = find_outer(camera);
  if (!rectangle) return std::nullopt;
  const Intrinsics outer = intrinsics(that_shows(*rectangle, pinhole));
  return with_intrinsics(pinhole, (1 - options.alpha) * inner + options.alpha * outer);
}

UndistortionMap undistortion_map(const Camera& camera, const Camera& pinhole) {
  UndistortionMap map{cv::Mat::zeros(pinhole.height, pinhole.width, CV_32FC2),
                      cv::Mat::zeros(pinhole.height, pinhole.width, CV_8U)};
  for (int row = 0; row < pinhole.height; ++row) {
    for (int column = 0; column < pinhole.width; ++column) {
      const Eigen::Vector3d ray((column - pinhole.cx) / pinhole.fx, (row - pinhole.cy) / pinhole.fy, 1);
      const auto seen = project(camera, ray);
      // Half a pixel beyond the centres of the outermost pixels still lies on them.
      if (!seen || !is_inside(camera, seen->pixel, -0.5)) continue;
      map.source_px.at<cv::Vec2f>(row, column) = {static_cast<float>(seen->pixel.x()),
                                                  static_cast<float>(seen->pixel.y())};
      map.is_seen.at<std::uint8_t>(row, column) = 255;
    }
  }
  return map;
}

cv::Mat undistorted_image(const cv::Mat& image, const UndistortionMap& map) {
  cv::Mat undistorted;
  // The border is repeated, not black, as the kernel reaches four pixels beyond it.
  cv::remap(image, undistorted, map.source_px, cv::noArray(), cv::INTER_LANCZOS4, cv::BORDER_REPLICATE);
  undistorted.setTo(cv::Scalar::all(0), map.is_seen == 0);
  return undistorted;
}

}  // namespace alidade
