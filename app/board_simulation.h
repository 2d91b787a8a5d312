// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "calib/boards/board.h"
#include "camera/camera.h"
#include "datasets/board_poses.h"
#include "datasets/rendered_plane.h"
#include "view/report.h"

namespace alidade {

/// What `simulate board` draws.
struct BoardSimulationOptions {
  Board board;
  Camera camera;
  int images = 20;
  BoardPoseOptions poses;
  PlaneRenderOptions rendering;
  Eigen::Vector2d bulge_mm = Eigen::Vector2d::Zero();  ///< height of the board's middle over its left and right, and
                                                       ///< over its upper and lower rim
  unsigned seed = 1;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const BoardSimulationOptions& options);

/// Pictures of a board before a camera, with truth.
class BoardSimulation {
 public:
  /// Throws as validate, and as pattern_of for a board that cannot be drawn.
  explicit BoardSimulation(const BoardSimulationOptions& options);

  int count() const { return static_cast<int>(T_camera_board_.size()); }

  /// The picture, CV_8UC1. Throws std::out_of_range for one that is not there, as T_board_camera.
  cv::Mat image(int i) const;

  /// The camera's pose in the board's frame, m.
  Eigen::Isometry3d T_board_camera(int i) const { return T_camera_board_.at(static_cast<std::size_t>(i)).inverse(); }

 private:
  BoardSimulationOptions options_;
  PlaneRenderer renderer_;
  std::vector<Eigen::Isometry3d> T_camera_board_;
};

/// The content of summary.json after `written` images.
nlohmann::json summary_of(const BoardSimulationOptions& options, int written);

/// The page: the board, the camera and `shown` images.
Report report_of(const BoardSimulationOptions& options, const std::vector<cv::Mat>& shown, int written);

}  // namespace alidade
