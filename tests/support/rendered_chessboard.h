// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace alidade::test {

/// A chessboard with a white margin of one square before a grey wall, as a sharp lens sees it.
struct RenderedChessboard {
  int columns = 9, rows = 6;  ///< inner corners
  /// Maps the board, in squares from inner corner 0, to pixels. The square inside corner 0 is dark.
  Eigen::Matrix3d H_pixel_board = Eigen::Matrix3d::Identity();
  int width = 320, height = 240;
};

/// A plane's homography: `centre` of the board at `pixel`, squares of `square_px` there, turned by `turn_rad` in the
/// image and away from it about the board's axes, as far as `tilt` says: the change of scale over one square.
struct BoardPlacement {
  Eigen::Vector2d pixel = {160, 120};
  double square_px = 25;
  double turn_rad = 0;
  Eigen::Vector2d tilt = {0, 0};
};

RenderedChessboard placed_chessboard(int columns, int rows, const BoardPlacement& placement);

/// Where the inner corners are, row by row, px.
std::vector<Eigen::Vector2d> true_corners(const RenderedChessboard& board);

/// The image: exact to 0.01 px at every edge (4 x 4 samples in a pixel), then blurred by a Gaussian of blur_px along x
/// and y. 8 bits, without noise.
cv::Mat render(const RenderedChessboard& board, const Eigen::Vector2d& blur_px = {0.7, 0.7});

/// The image with Gaussian noise of `sigma` grey levels.
cv::Mat with_noise(const cv::Mat& image, double sigma, int seed);

}  // namespace alidade::test
