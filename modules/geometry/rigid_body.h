// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace alidade {

/// A marker fixed to a body.
struct BodyMarker {
  int id = 0;                                        ///< by which detectors tell it from all other markers
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< m
};

/// A rigid body and the markers that it carries; ids are unique among all bodies that are tracked together.
struct RigidBody {
  std::string name;
  std::vector<BodyMarker> markers;
};

}  // namespace alidade
