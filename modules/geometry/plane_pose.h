// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/plane.h"
#include "geometry/pose.h"

namespace alidade {

/// A point of a body that lies in a plane of the world. Two of them through a camera's centre are a pixel.
struct PlaneConstraint {
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< m
  Plane plane_world;
  double weight = 1.0;  ///< 1 / σ², σ the standard deviation of the point's distance from the plane, in m
};

/// A pose in which points are near their planes.
struct PlanePose {
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  double chi2 = 0.0;                        ///< Σ weight · distance²
  Matrix6d information = Matrix6d::Zero();  ///< of the right perturbation, m and rad; its rank tells what is determined
};

}  // namespace alidade
