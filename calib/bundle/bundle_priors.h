// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "calib/bundle/board_bundle.h"

namespace alidade {

/// What is believed of a shared parameter before any view: that it is 0, with this information (1/sigma²).
struct BundlePrior {
  int place = 0;  ///< in the vector of shared parameters
  double value = 0;
  double information = 0;
};

/// Weak beliefs that keep the equations regular where the views say nothing: the board is nearly flat, and no
/// coefficient of the distortion alone moves the image's corner by more than its distance from the centre.
std::vector<BundlePrior> bundle_priors(const BoardBundle& bundle, const BoardShape& shape,
                                       const BundleFreedom& freedom);

/// How much the corners' offsets move, turn and scale the whole board, in shape.rigid_modes.
Eigen::VectorXd rigid_part(const BoardWarp& warp, const BoardShape& shape);

/// That they do not, as information of each mode (1/m²): the board's poses say where it is, and its stated size is true
/// of all corners together.
double rigid_information(const BoardShape& shape);

}  // namespace alidade
