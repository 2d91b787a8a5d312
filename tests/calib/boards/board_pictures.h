// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "calib/boards/board_drawing.h"
#include "calib/boards/board_pattern.h"
#include "calib/boards/board_text.h"
#include "calib/boards/board_view.h"
#include "datasets/board_poses.h"
#include "datasets/rendered_plane.h"

namespace alidade::test {

/// A board before a camera with a barrel-shaped lens, in random poses.
struct BoardPictures {
  Camera camera{640, 480, 520, 520, 319.5, 239.5, BrownConrady{-0.25, 0.08, 0.001, 0.001}};
  Board board;
  std::vector<Eigen::Isometry3d> poses;  ///< T_camera_board
  std::vector<cv::Mat> images;

  /// Where corner `id` is in image `i`, px.
  Eigen::Vector2d pixel(std::size_t i, int id) const {
    return project(camera, poses[i] * corners_m(board)[static_cast<std::size_t>(id)])->pixel;
  }

  /// How far a view's corners are from the truth: RMS per coordinate of error over sigma_px, and of the error in px.
  struct Errors {
    double over_sigma = 0, rms_px = 0;
  };
  Errors errors(std::size_t i, const BoardView& view) const {
    double over_sigma = 0, px2 = 0;
    for (const BoardCorner& corner : view.corners) {
      const double error2 = (corner.pixel - pixel(i, corner.id)).squaredNorm() / 2;
      px2 += error2;
      over_sigma += error2 / (corner.sigma_px * corner.sigma_px);
    }
    const auto count = static_cast<double>(view.corners.size());
    return {std::sqrt(over_sigma / count), std::sqrt(px2 / count)};
  }
};

inline BoardPictures picture(const std::string& text, int count, const PlaneRenderOptions& options,
                             const BoardPoseOptions& poses = {}) {
  BoardPictures pictures;
  pictures.board = parse_board(text);
  const BoardDrawing drawing = draw_board(pictures.board, 4000, 0.01);
  const PlaneRenderer renderer(pictures.camera, {drawing.image, drawing.pixels_per_m, drawing.origin_px});
  pictures.poses = board_poses(pictures.camera, pattern_of(pictures.board).extent, count, 2, poses);
  PlaneRenderOptions each = options;
  for (const auto& T_camera_board : pictures.poses) {
    pictures.images.push_back(renderer.render(T_camera_board, each));
    ++each.seed;
  }
  return pictures;
}

inline PlaneRenderOptions good_light() {
  PlaneRenderOptions options;
  options.blur_px = 0.6;
  options.noise_grey = 2;
  return options;
}

}  // namespace alidade::test
