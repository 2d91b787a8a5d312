// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/boards/board_view.h"
#include "calib/cameras/lens_model.h"
#include "calib/guide/capture_coverage.h"

namespace alidade {

/// What views tell of a camera while more are being taken. Uncertainties are standard deviations (larger axis) of a
/// pixel's place at the boards' distance, infinite where the lens has no direction; see pixel_covariance.
struct CaptureEstimate {
  Camera camera;
  std::vector<Eigen::Isometry3d> T_camera_board;  ///< of every view
  double rms_px = 0;
  double focal_sigma = 0;             ///< standard deviation of fx, a share of it
  std::vector<double> cell_sigma_px;  ///< the largest of a cell's four corners, cells row by row
  double centre_px = 0;               ///< in the middle of the image
  double corner_px = 0;               ///< the largest of the image's four corners, a fiftieth of the width inside
  double worst_px = 0;                ///< the largest of all cells
};

/// A quick calibration: one lens, a bulging board, no held-out views. Empty where the views do not determine it, or fx
/// is not known to 10 %.
std::optional<CaptureEstimate> estimate_camera(LensModel lens, const ImageExtent& image, const BoardShape& shape,
                                               std::span<const BoardView> views, const CoverageOptions& cells);

}  // namespace alidade
