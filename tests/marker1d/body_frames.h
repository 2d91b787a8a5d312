// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "datasets/body_scene.h"
#include "marker1d/paper_tracker.h"

namespace alidade::test {

/// A frame's planes beside the true pose.
struct BodyFrame {
  PaperFrame planes;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
};

/// The scene's frames for its first body; planes as they are seen from near the true pose.
inline std::vector<BodyFrame> body_frames(BodyScene& scene) {
  std::vector<BodyFrame> frames;
  while (const auto frame = scene.next()) {
    const Eigen::Isometry3d T = pose_in_scene(0, frame->time);
    frames.push_back({{frame->time, marker_planes(scene.detectors(), scene.bodies()[0], frame->readings, T)}, T});
  }
  return frames;
}

inline PaperSums sum(const RigidBody& body, std::span<const MarkerPlane> planes) {
  PaperSums sums(body, {0, 0, 1});
  for (const MarkerPlane& plane : planes) sums.add(plane, 1.0);
  return sums;
}

}  // namespace alidade::test
