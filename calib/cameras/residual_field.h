// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "calib/bundle/bundle_fit.h"

namespace alidade {

/// Mean residual in one cell of the image.
struct ResidualCell {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();
  int count = 0;
};

/// What the lens leaves: residuals of one camera averaged by their place in the image. Noise averages out, a lens of
/// the wrong kind does not.
struct ResidualField {
  int columns = 0, rows = 0;
  std::vector<ResidualCell> cells;  ///< row by row
  double systematic_px = 0;         ///< RMS of the cells' means beyond what noise leaves in them
  double noise_px = 0;              ///< RMS length of a residual about its cell's mean
};

/// Cells with fewer than six corners count for nothing in the two figures.
ResidualField residual_field(const BundleFit& fit, const BoardShape& shape, int camera, int columns = 10);

/// Share of the image's cells in which a corner was seen.
double coverage(const ResidualField& field);

}  // namespace alidade
