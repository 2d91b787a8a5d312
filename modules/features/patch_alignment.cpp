// SPDX-License-Identifier: Apache-2.0
#include "features/patch_alignment.h"

#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace alidade {

std::optional<AlignedPatch> align_patch(const cv::Mat& reference, const Eigen::Vector2d& reference_pixel,
                                        const cv::Mat& image, const Eigen::Vector2d& pixel,
                                        const Eigen::Matrix2d& A_image_reference,
                                        const PatchAlignmentOptions& options) {
  const double half = 0.5 * (options.side_px - 1);
  const double reach = half * A_image_reference.cwiseAbs().rowwise().sum().maxCoeff() + options.most_shift_px + 3.0;
  const auto border = [](const cv::Mat& m, const Eigen::Vector2d& p) {
    return std::min({p.x(), p.y(), m.cols - 1 - p.x(), m.rows - 1 - p.y()});
  };
  if (!(reach < 6.0 * half) || border(reference, reference_pixel) < half + 1 || border(image, pixel) < reach + 1) {
    return std::nullopt;
  }
  cv::Mat patch;
  cv::getRectSubPix(reference, cv::Size(options.side_px, options.side_px),
                    cv::Point2f(static_cast<float>(reference_pixel.x()), static_cast<float>(reference_pixel.y())),
                    patch, CV_32F);
  const int r = static_cast<int>(std::ceil(reach));
  const int x0 = static_cast<int>(std::lround(pixel.x())) - r;
  const int y0 = static_cast<int>(std::lround(pixel.y())) - r;
  cv::Mat window;
  image(cv::Rect(x0, y0, 2 * r + 1, 2 * r + 1)).convertTo(window, CV_32F);
  // window pixel = W [patch pixel; 1]
  const Eigen::Vector2d centre = Eigen::Vector2d::Constant(half);
  const Eigen::Vector2d t = pixel - Eigen::Vector2d(x0, y0) - A_image_reference * centre;
  cv::Matx23f W(static_cast<float>(A_image_reference(0, 0)), static_cast<float>(A_image_reference(0, 1)),
                static_cast<float>(t.x()), static_cast<float>(A_image_reference(1, 0)),
                static_cast<float>(A_image_reference(1, 1)), static_cast<float>(t.y()));
  cv::Mat warp(W);
  double correlation = 0;
  try {
    const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, options.most_iterations, 1e-4);
    correlation = cv::findTransformECC(patch, window, warp, cv::MOTION_AFFINE, until, cv::noArray(), 3);
  } catch (const cv::Exception&) {  // the patches are uncorrelated, or the window has no texture
    return std::nullopt;
  }
  if (!(correlation >= options.least_correlation)) return std::nullopt;
  const auto at = [&](int row, int col) { return static_cast<double>(warp.at<float>(row, col)); };
  AlignedPatch aligned;
  aligned.correlation = correlation;
  aligned.pixel = Eigen::Vector2d(at(0, 0) * half + at(0, 1) * half + at(0, 2) + x0,
                                  at(1, 0) * half + at(1, 1) * half + at(1, 2) + y0);
  if (!((aligned.pixel - pixel).norm() <= options.most_shift_px)) return std::nullopt;
  return aligned;
}

}  // namespace alidade
