// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/opencv_calibration.h"

#include <cmath>

#include <opencv2/calib3d.hpp>

namespace alidade {

std::optional<OpencvCalibration> calibrate_by_opencv(const ImageExtent& image, const BoardShape& shape,
                                                     std::span<const BoardView> views) {
  std::vector<std::vector<cv::Point3f>> boards;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (const BoardView& view : views) {
    auto& board = boards.emplace_back();
    auto& pixel = pixels.emplace_back();
    for (const BoardCorner& corner : view.corners) {
      const Eigen::Vector3f p = shape.corners_m[static_cast<std::size_t>(corner.id)].cast<float>();
      board.emplace_back(p.x(), p.y(), p.z());
      pixel.emplace_back(static_cast<float>(corner.pixel.x()), static_cast<float>(corner.pixel.y()));
    }
  }
  cv::Mat K, distortion;
  OpencvCalibration result;
  try {
    std::vector<cv::Mat> rotations, translations;
    result.rms_px =
        cv::calibrateCamera(boards, pixels, {image.width, image.height}, K, distortion, rotations, translations);
  } catch (const cv::Exception&) {  // too few views or corners in one line
    return std::nullopt;
  }
  const auto k = [&](int i) { return distortion.at<double>(i); };
  result.camera = {image.width,
                   image.height,
                   K.at<double>(0, 0),
                   K.at<double>(1, 1),
                   K.at<double>(0, 2),
                   K.at<double>(1, 2),
                   BrownConrady{k(0), k(1), k(2), k(3), k(4)},
                   0.0};
  return std::isfinite(result.rms_px) ? std::optional(result) : std::nullopt;
}

}  // namespace alidade
