// SPDX-License-Identifier: Apache-2.0
#include "datasets/lens_warp.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

Eigen::Vector2d undistort_or_throw(const Camera& camera, const Eigen::Vector2d& pixel) {
  const auto xy = undistort(camera, pixel);
  if (!xy) throw std::invalid_argument("the distortion has no inverse in a part of the image");
  return *xy;
}

Camera widened(const Camera& camera) {
  Eigen::AlignedBox2d seen;  // normalised coordinates of the image's rim
  for (int i = 0; i <= 4 * 64; ++i) {
    const double along = (i % 64) / 64.0;
    const int side = i / 64 % 4;
    const double u = side == 0 ? along : side == 1 ? 1.0 : side == 2 ? 1.0 - along : 0.0;
    const double v = side == 0 ? 0.0 : side == 1 ? along : side == 2 ? 1.0 : 1.0 - along;
    seen.extend(undistort_or_throw(camera, {u * camera.width - 0.5, v * camera.height - 0.5}));
  }
  constexpr double kMargin_px = 3.0;
  Camera wide = camera;
  wide.distortion = BrownConrady{};
  wide.cx = std::ceil(-seen.min().x() * camera.fx + kMargin_px);
  wide.cy = std::ceil(-seen.min().y() * camera.fy + kMargin_px);
  wide.width = static_cast<int>(std::ceil(wide.cx + seen.max().x() * camera.fx + kMargin_px));
  wide.height = static_cast<int>(std::ceil(wide.cy + seen.max().y() * camera.fy + kMargin_px));
  if (wide.width > 3 * camera.width || wide.height > 3 * camera.height) {
    throw std::invalid_argument("the distortion takes more than three times the image");
  }
  return wide;
}

cv::Mat make_map(const Camera& camera, const Camera& pinhole) {
  cv::Mat map(camera.height, camera.width, CV_32FC2);
  cv::parallel_for_({0, camera.height}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const Eigen::Vector2d xy = undistort_or_throw(camera, Eigen::Vector2d(x, y));
        map.at<cv::Vec2f>(y, x) = {static_cast<float>(pinhole.fx * xy.x() + pinhole.cx),
                                   static_cast<float>(pinhole.fy * xy.y() + pinhole.cy)};
      }
    }
  });
  return map;
}

}  // namespace

LensWarp::LensWarp(const Camera& camera, int supersampling)
    : camera_(camera),
      pinhole_(widened(camera)),
      map_(make_map(resized(camera, supersampling), resized(pinhole_, supersampling))),
      depth_map_(make_map(camera, pinhole_)) {}

cv::Mat LensWarp::distort(const cv::Mat& large) const {
  cv::Mat warped, picture;
  cv::remap(large, warped, map_, {}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::resize(warped, picture, {camera_.width, camera_.height}, 0, 0, cv::INTER_AREA);
  return picture;
}

cv::Mat LensWarp::distort_depth(const cv::Mat& depth) const {
  cv::Mat picture;
  cv::remap(depth, picture, depth_map_, {}, cv::INTER_NEAREST, cv::BORDER_REPLICATE);
  return picture;
}

}  // namespace alidade
