// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace alidade {

/// The i-th of n rotations that cover SO(3) evenly, i in 0..n-1. Source: Alexa, Super-Fibonacci Spirals, CVPR 2022.
Eigen::Matrix3d spread_rotation(int i, int n);

}  // namespace alidade
