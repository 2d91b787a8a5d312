// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/held_out.h"

#include <cmath>

#include "calib/cameras/board_placement.h"

namespace alidade {
namespace {

struct SquareSum {
  double sum = 0;
  int count = 0;
};

// What a camera leaves on views whose boards are placed by them alone. A view without a place counts as 10 px.
SquareSum misfit_of(const BoardBundle& fitted, const BoardShape& shape, const std::vector<BundleView>& views) {
  SquareSum squares;
  for (const BundleView& view : views) {
    squares.count += static_cast<int>(view.corners.size());
    const auto T = place_board(fitted.cameras.front().camera, shape, fitted.warp, view.corners);
    if (!T) {
      squares.sum += 100.0 * static_cast<double>(view.corners.size());
      continue;
    }
    BundleView alone = view;
    alone.frame = 0;
    const BoardBundle placed{fitted.cameras, {*T}, fitted.warp};
    for (const Eigen::Vector2d& r : residuals_px(placed, shape, alone)) squares.sum += r.squaredNorm();
  }
  return squares;
}

}  // namespace

BundleFreedom CameraModel::freedom() const {
  BundleFreedom freedom;
  freedom.intrinsics = {free_intrinsics(lens)};
  freedom.corners = free_corners;
  freedom.warp = !free_corners;  // which the corners express, too
  return freedom;
}

std::optional<BundleFit> fit_camera(const CameraModel& model, const ImageExtent& image, const BoardShape& shape,
                                    const std::vector<BundleView>& views, const BundleFitOptions& options) {
  auto start = start_camera_bundle(model.lens, image, shape, views);
  if (!start) return std::nullopt;
  BundleFreedom regular = model.freedom();
  regular.corners = false;
  BundleFit fit = fit_bundle(start->bundle, shape, std::move(start->views), regular, options);
  return model.free_corners ? fit_corners(fit, shape, model.freedom(), options) : fit;
}

std::optional<double> held_out_rms_px(const CameraModel& model, const ImageExtent& image, const BoardShape& shape,
                                      const std::vector<BundleView>& views, const BundleFitOptions& options,
                                      int folds) {
  SquareSum all;
  for (int fold = 0; fold < folds; ++fold) {
    std::vector<BundleView> training, held_out;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const bool is_held_out = static_cast<int>(i) % folds == fold;
      auto& side = is_held_out ? held_out : training;
      side.push_back(views[i]);
      side.back().frame = static_cast<int>(side.size()) - 1;
    }
    if (held_out.empty()) continue;
    if (training.size() < 3) return std::nullopt;
    const auto fit = fit_camera(model, image, shape, training, options);
    if (!fit) return std::nullopt;
    const SquareSum squares = misfit_of(fit->bundle, shape, held_out);
    all.sum += squares.sum;
    all.count += squares.count;
  }
  return all.count == 0 ? std::nullopt : std::optional(std::sqrt(all.sum / all.count));
}

}  // namespace alidade
