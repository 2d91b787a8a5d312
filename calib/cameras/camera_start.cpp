// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/camera_start.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <opencv2/calib3d.hpp>

#include "calib/bundle/board_placement.h"

namespace alidade {
namespace {

// Zhang's closed form with one focal length and the principal point in the middle; empty where it gives no length.
std::optional<double> zhang_focal_px(const ImageExtent& image, const BoardShape& shape,
                                     std::span<const BundleView> views) {
  std::vector<std::vector<cv::Point3f>> boards;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (const BundleView& view : views) {
    if (view.corners.size() < 6) continue;
    auto& board = boards.emplace_back();
    auto& pixel = pixels.emplace_back();
    for (const BoardCorner& corner : view.corners) {
      const Eigen::Vector3f p =
          shape.corners_m[static_cast<std::size_t>(corner.id)].cast<float>() / static_cast<float>(shape.extent_m);
      board.emplace_back(p.x(), p.y(), 0.f);
      pixel.emplace_back(static_cast<float>(corner.pixel.x()), static_cast<float>(corner.pixel.y()));
    }
  }
  if (boards.size() < 2) return std::nullopt;
  try {
    const cv::Mat K = cv::initCameraMatrix2D(boards, pixels, {image.width, image.height}, 1.0);
    const double focal = K.at<double>(0, 0);
    if (std::isfinite(focal) && focal > 0.15 * image.width && focal < 30.0 * image.width) return focal;
  } catch (const cv::Exception&) {  // corners in one line have no homography
  }
  return std::nullopt;
}

// At most `count` views, evenly through all.
std::vector<BundleView> some_of(const std::vector<BundleView>& views, std::size_t count) {
  if (views.size() <= count) return views;
  std::vector<BundleView> some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(views[i * views.size() / count]);
  return some;
}

// Robust misfit of a camera: what boards placed with it leave; a view without a pose counts as 100 px.
double misfit(const Camera& camera, const BoardShape& shape, std::span<const BundleView> views) {
  double sum = 0;
  for (const BundleView& view : views) {
    const auto T = place_board(camera, shape, {}, view.corners);
    double worst = 100;
    if (T) {
      const BoardBundle bundle{{{camera, Eigen::Isometry3d::Identity()}}, {*T}, {}};
      BundleView alone = view;
      alone.frame = 0;
      double squares = 0;
      for (const Eigen::Vector2d& r : residuals_px(bundle, shape, alone)) squares += r.squaredNorm();
      worst = std::min(worst, std::sqrt(squares / static_cast<double>(view.corners.size())));
    }
    sum += worst;
  }
  return sum;
}

std::vector<double> focal_candidates(LensModel lens, const ImageExtent& image, const BoardShape& shape,
                                     std::span<const BundleView> views) {
  std::vector<double> candidates;
  const std::vector<double> shares = lens == LensModel::Fisheye
                                         ? std::vector<double>{0.2, 0.27, 0.35, 0.45, 0.6, 0.9, 1.5}
                                         : std::vector<double>{0.4, 0.6, 0.85, 1.2, 1.8, 3.0};
  for (const double share : shares) candidates.push_back(share * image.width);
  if (const auto focal = zhang_focal_px(image, shape, views)) candidates.push_back(*focal);
  return candidates;
}

}  // namespace

std::optional<CameraStart> start_camera_bundle(LensModel lens, const ImageExtent& image, const BoardShape& shape,
                                               std::vector<BundleView> views) {
  const auto tried = some_of(views, 6);
  std::optional<Camera> best;
  double least = 0;
  for (const double focal : focal_candidates(lens, image, shape, tried)) {
    const Camera camera = start_camera(lens, image.width, image.height, focal);
    const double found = misfit(camera, shape, tried);
    if (best && found >= least) continue;
    best = camera;
    least = found;
  }
  if (!best) return std::nullopt;
  CameraStart start{{{{*best, Eigen::Isometry3d::Identity()}}, {}, {}}, std::move(views)};
  int placed = 0;
  for (BundleView& view : start.views) {
    const auto T = place_board(*best, shape, {}, view.corners);
    placed += T.has_value();
    if (!T) std::fill(view.weights.begin(), view.weights.end(), 0.0);
    start.bundle.T_rig_board.push_back(T.value_or(Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1))));
  }
  if (placed < 2) return std::nullopt;
  BundleFreedom few;  // focal lengths and the strongest coefficient first: from afar, more would overfit
  few.intrinsics = {{0, 1, 4}};
  few.warp = false;
  start.bundle = solve_bundle(std::move(start.bundle), shape, start.views, few, {30}).bundle;
  return start;
}

}  // namespace alidade
