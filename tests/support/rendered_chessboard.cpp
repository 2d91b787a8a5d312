// SPDX-License-Identifier: Apache-2.0
#include "tests/support/rendered_chessboard.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace alidade::test {
namespace {

constexpr int kSamples = 4;  // of a pixel, along a side
constexpr double kDark = 40, kLight = 210, kWall = 120;

// -1 and 1 by turns, with ramps as wide as a sample: sums over samples then show an edge where it is.
double stripes(double x, double sample) {
  const double to_edge = std::abs(x - 2 * std::round(x / 2)) - 0.5;  // of stripes centred on the even integers
  return std::clamp(-to_edge / sample, -1.0, 1.0);
}

double grey_at(const RenderedChessboard& board, const Eigen::Vector2d& p, double sample) {
  const auto inside = [&](double margin) {
    return (p.array() > -1 - margin).all() && p.x() < board.columns + margin && p.y() < board.rows + margin;
  };
  if (!inside(1)) return kWall;
  if (!inside(0)) return kLight;
  const double pattern = stripes(p.x() - 0.5, sample) * stripes(p.y() - 0.5, sample);  // 1: dark, as inside corner 0
  return 0.5 * (kLight + kDark) - 0.5 * (kLight - kDark) * pattern;
}

}  // namespace

RenderedChessboard placed_chessboard(int columns, int rows, const BoardPlacement& placement) {
  const double c = std::cos(placement.turn_rad), s = std::sin(placement.turn_rad);
  Eigen::Matrix3d centred = Eigen::Matrix3d::Identity(), tilted = Eigen::Matrix3d::Identity(), seen;
  centred.topRightCorner<2, 1>() = -0.5 * Eigen::Vector2d(columns - 1, rows - 1);
  tilted.bottomLeftCorner<1, 2>() = placement.tilt.transpose();
  seen << placement.square_px * c, -placement.square_px * s, placement.pixel.x(),  //
      placement.square_px * s, placement.square_px * c, placement.pixel.y(), 0, 0, 1;
  return {.columns = columns, .rows = rows, .H_pixel_board = seen * tilted * centred};
}

std::vector<Eigen::Vector2d> true_corners(const RenderedChessboard& board) {
  std::vector<Eigen::Vector2d> corners;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      corners.push_back((board.H_pixel_board * Eigen::Vector3d(column, row, 1)).hnormalized());
    }
  }
  return corners;
}

cv::Mat render(const RenderedChessboard& board, const Eigen::Vector2d& blur_px) {
  Eigen::Matrix3d H_pixel_sample = Eigen::Matrix3d::Identity();
  H_pixel_sample.topLeftCorner<2, 2>() /= kSamples;
  H_pixel_sample.topRightCorner<2, 1>().setConstant(0.5 / kSamples - 0.5);
  const Eigen::Matrix3d H_board_sample = board.H_pixel_board.inverse() * H_pixel_sample;
  cv::Mat samples(kSamples * board.height, kSamples * board.width, CV_32F), image, grey;
  for (int y = 0; y < samples.rows; ++y) {
    for (int x = 0; x < samples.cols; ++x) {
      const Eigen::Vector2d p = (H_board_sample * Eigen::Vector3d(x, y, 1)).hnormalized();
      const Eigen::Vector2d beside = (H_board_sample * Eigen::Vector3d(x + 1, y, 1)).hnormalized();
      samples.at<float>(y, x) = static_cast<float>(grey_at(board, p, (beside - p).norm()));
    }
  }
  // The lens blurs before the pixels sample: the other way round edges along the pixels' rows would be staircases.
  cv::GaussianBlur(samples, samples, {}, kSamples * blur_px.x(), kSamples * blur_px.y());
  cv::resize(samples, image, {board.width, board.height}, 0, 0, cv::INTER_AREA);
  image.convertTo(grey, CV_8U);
  return grey;
}

cv::Mat with_noise(const cv::Mat& image, double sigma, int seed) {
  cv::Mat noise(image.size(), CV_32F), noisy;
  cv::RNG rng(static_cast<uint64_t>(seed));
  rng.fill(noise, cv::RNG::NORMAL, 0, sigma);
  cv::add(image, noise, noisy, {}, CV_8U);
  return noisy;
}

}  // namespace alidade::test
