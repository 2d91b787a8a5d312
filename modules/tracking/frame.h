// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "core/time.h"
#include "estimation/pose_update.h"
#include "geometry/pose.h"

namespace alidade {

/// One image as the tracker takes it.
struct ImageFrame {
  int index = 0;  ///< in its source, from 0
  Timestamp time{};
  std::string name;
  cv::Mat grey;    ///< 8-bit
  cv::Mat colour;  ///< 8-bit BGR, for the colours of map points; may be empty
};

/// What the tracker knows of the camera at a frame.
enum class FrameState {
  Waiting,    ///< no map yet; the report's reason says what is missing
  Tracked,    ///< measured
  Predicted,  ///< not measured, but within reach of the motion model
  Lost,       ///< neither; it is looked for in the map at every further frame
};

/// A map point found in a frame.
struct FrameSighting {
  int point = -1;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  bool is_inlier = false;
};

/// Where a map point was expected before it was looked for.
struct FrameExpectation {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of the innovation, px²
};

/// The tracker's word on one frame.
struct FrameReport {
  int index = 0;
  Timestamp time{};
  std::string name;
  FrameState state = FrameState::Waiting;
  std::string reason;  ///< why it waits, or what was lost; empty while tracked
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< meaningful while tracked or predicted
  Matrix6d covariance = Matrix6d::Zero();                            ///< of the right perturbation, m and rad
  PoseLikelihood likelihood;  ///< what its sightings alone say of the pose; no information where it is not tracked
  double chi2_per_dof = 0;
  double sigma_px = 1;  ///< measurement noise in use
  bool is_keyframe = false;
  int inlier_count = 0;  ///< of the sightings, kept or not
  std::vector<FrameSighting> sightings;
  std::vector<FrameExpectation> expectations;  ///< one per sighting, or none (a first sight, a report of long ago)

  bool has_pose() const { return state == FrameState::Tracked || state == FrameState::Predicted; }
};

const char* to_string(FrameState state);

}  // namespace alidade
