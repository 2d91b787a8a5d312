// SPDX-License-Identifier: Apache-2.0
#include "calib/guide/capture_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "calib/bundle/projection_uncertainty.h"
#include "calib/cameras/held_out.h"

namespace alidade {
namespace {

std::vector<BundleView> numbered(std::span<const BoardView> views) {
  std::vector<BundleView> bundle;
  for (const BoardView& view : views) {
    bundle.push_back({0, static_cast<int>(bundle.size()), view.corners, std::vector<double>(view.corners.size(), 1.0)});
  }
  return bundle;
}

// Standard deviations at the corners of the cells, those at the border moved inside, row by row.
class CellUncertainty {
 public:
  CellUncertainty(const BundleFit& fit, const BundleFreedom& freedom, const BundleCovariance& covariance,
                  double distance_m)
      : fit_(fit), freedom_(freedom), covariance_(covariance), distance_m_(distance_m) {}

  double at(const Eigen::Vector2d& pixel) const {
    const auto C = pixel_covariance(covariance_, fit_.bundle, freedom_, 0, pixel, distance_m_);
    if (!C || !C->allFinite()) return std::numeric_limits<double>::infinity();
    return std::sqrt(
        std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(*C, Eigen::EigenvaluesOnly).eigenvalues()[1]));
  }

  std::vector<double> at_cell_corners(const CoverageOptions& cells) const {
    const Camera& camera = fit_.bundle.cameras.front().camera;
    const double inside = camera.width / 50.0;
    std::vector<double> sigmas;
    for (int row = 0; row <= cells.rows; ++row) {
      for (int column = 0; column <= cells.columns; ++column) {
        const double x = static_cast<double>(column) * camera.width / cells.columns - 0.5;
        const double y = static_cast<double>(row) * camera.height / cells.rows - 0.5;
        sigmas.push_back(at({std::clamp(x, inside, camera.width - 1 - inside),  //
                             std::clamp(y, inside, camera.height - 1 - inside)}));
      }
    }
    return sigmas;
  }

 private:
  const BundleFit& fit_;
  const BundleFreedom& freedom_;
  const BundleCovariance& covariance_;
  double distance_m_;
};

void measure_cells(const std::vector<double>& at_corners, const CoverageOptions& cells, CaptureEstimate& estimate) {
  const auto at = [&](int column, int row) {
    return at_corners[static_cast<std::size_t>(row * (cells.columns + 1) + column)];
  };
  for (int row = 0; row < cells.rows; ++row) {
    for (int column = 0; column < cells.columns; ++column) {
      estimate.cell_sigma_px.push_back(
          std::max({at(column, row), at(column + 1, row), at(column, row + 1), at(column + 1, row + 1)}));
    }
  }
  estimate.corner_px = std::max({at(0, 0), at(cells.columns, 0), at(0, cells.rows), at(cells.columns, cells.rows)});
  estimate.worst_px = *std::max_element(at_corners.begin(), at_corners.end());
}

}  // namespace

std::optional<CaptureEstimate> estimate_camera(LensModel lens, const ImageExtent& image, const BoardShape& shape,
                                               std::span<const BoardView> views, const CoverageOptions& cells) {
  const CameraModel model{lens, false};
  const BundleFreedom freedom = model.freedom();
  const auto fit = fit_camera(model, image, shape, numbered(views), {});
  if (!fit) return std::nullopt;
  CaptureEstimate estimate;
  estimate.camera = fit->bundle.cameras.front().camera;
  const auto covariance = bundle_covariance(*fit, shape, freedom);
  if (!covariance || find_fault(estimate.camera)) return std::nullopt;
  constexpr double kKnown = 0.1;
  const BundleLayout layout(fit->bundle, freedom);
  estimate.focal_sigma = intrinsics_sigma(*covariance, layout, 0)[0] / estimate.camera.fx;
  if (!(estimate.focal_sigma < kKnown)) return std::nullopt;
  estimate.T_camera_board = fit->bundle.T_rig_board;
  estimate.rms_px = rms_px(fit->bundle, shape, fit->views);
  const CellUncertainty uncertainty(*fit, freedom, *covariance, median_distance_m(*fit, shape, 0));
  estimate.centre_px = uncertainty.at({0.5 * (image.width - 1), 0.5 * (image.height - 1)});
  measure_cells(uncertainty.at_cell_corners(cells), cells, estimate);
  return estimate;
}

}  // namespace alidade
