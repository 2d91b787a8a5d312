// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "calib/cameras/camera_calibration.h"

namespace alidade {

/// How far apart two calibrations see the same direction, at one place of the image.
struct ProjectionGap {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< in the first
  Eigen::Vector2d gap_px = Eigen::Vector2d::Zero();
  double chi2 = 0;  ///< of the gap, by both covariances at that place; two degrees of freedom
};

/// Two calibrations of the same camera over a grid of `columns` places along a row, far away (1000 times the boards'
/// distance), after the rotation between their frames that brings them closest, each place weighted by its covariance.
/// Places where one of them has no direction are left out.
std::vector<ProjectionGap> compare_projections(const CameraCalibration& first, const CameraCalibration& second,
                                               const Board& board, int columns = 24);

}  // namespace alidade
