// SPDX-License-Identifier: Apache-2.0
#include "calib/cameras/held_out.h"

#include <algorithm>
#include <cmath>

#include "calib/bundle/board_placement.h"

namespace alidade {
namespace {

// Lengths (px) of what a camera leaves on views whose boards are placed by them alone, added to `lengths`. A view
// without a place counts as 10 px.
void add_misfit(const BoardBundle& fitted, const BoardShape& shape, const std::vector<BundleView>& views,
                std::vector<double>& lengths) {
  for (const BundleView& view : views) {
    const auto T = place_board(fitted.cameras.front().camera, shape, fitted.warp, view.corners);
    if (!T) {
      lengths.insert(lengths.end(), view.corners.size(), 10.0);
      continue;
    }
    BundleView alone = view;
    alone.frame = 0;
    const BoardBundle placed{fitted.cameras, {*T}, fitted.warp};
    for (const Eigen::Vector2d& r : residuals_px(placed, shape, alone)) lengths.push_back(r.norm());
  }
}

HeldOutError summarise(std::vector<double> lengths) {
  double squares = 0;
  for (const double length : lengths) squares += length * length;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return {std::sqrt(squares / static_cast<double>(lengths.size())), *middle};
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

std::optional<HeldOutError> held_out_error(const CameraModel& model, const ImageExtent& image, const BoardShape& shape,
                                           const std::vector<BundleView>& views, const BundleFitOptions& options,
                                           int folds) {
  std::vector<double> lengths;
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
    add_misfit(fit->bundle, shape, held_out, lengths);
  }
  return lengths.empty() ? std::nullopt : std::optional(summarise(std::move(lengths)));
}

}  // namespace alidade
