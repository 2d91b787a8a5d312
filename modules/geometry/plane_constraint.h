// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

#include "geometry/plane.h"

namespace alidade {

/// A point of a body that lies in a plane of the world. Two of them through a camera's centre are a pixel.
struct PlaneConstraint {
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< m
  Plane plane_world;
  double weight = 1.0;  ///< 1 / σ², σ the standard deviation of the point's distance from the plane, in m
};

/// Throws std::invalid_argument for a normal that is not of unit length or a weight that is not positive.
void require_planes(std::span<const PlaneConstraint> constraints);

}  // namespace alidade
