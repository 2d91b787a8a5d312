// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/placed_markers.h"

#include <Eigen/LU>
#include <opencv2/calib3d.hpp>

namespace alidade {
namespace {

using Eigen::Vector2d;

Vector2d centre_on_board(const PlacedMarker& marker) {
  return 0.5 * (marker.on_board.corners[0] + marker.on_board.corners[2]);
}

Vector2d centre_in_image(const PlacedMarker& marker) {
  Vector2d sum = Vector2d::Zero();
  for (const Vector2d& pixel : marker.pixels) sum += pixel;
  return 0.25 * sum;
}

bool are_neighbours(const PlacedMarker& a, const PlacedMarker& b) {
  constexpr int kReach =
      1;  // squares or tags: of a ChArUco board of the other layout, only markers a row apart disagree
  return std::abs(a.on_board.column - b.on_board.column) <= kReach &&
         std::abs(a.on_board.row - b.on_board.row) <= kReach;
}

// Whether a marker has its neighbour where the other one is: off by less than half of their distance.
bool agree(const PlacedMarker& a, const Eigen::Matrix3d& H_image_board, const PlacedMarker& b) {
  const Vector2d expected = map_by(H_image_board, centre_on_board(b));
  const Vector2d here = centre_in_image(a);
  const double error = (centre_in_image(b) - expected).norm();
  return error < 0.5 * (expected - here).norm() / (centre_on_board(b) - centre_on_board(a)).norm() *
                     (a.on_board.corners[1] - a.on_board.corners[0]).norm();
}

}  // namespace

std::optional<Eigen::Matrix3d> homography_between(std::span<const Vector2d> on_board,
                                                  std::span<const Vector2d> in_image, Outliers outliers) {
  if (on_board.size() < 4) return std::nullopt;
  std::vector<cv::Point2d> from, to;
  for (const Vector2d& p : on_board) from.emplace_back(p.x(), p.y());
  for (const Vector2d& p : in_image) to.emplace_back(p.x(), p.y());
  const cv::Mat H = cv::findHomography(from, to, outliers == Outliers::Some ? cv::LMEDS : 0);
  if (H.empty()) return std::nullopt;
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(H.ptr<double>());
}

std::optional<Eigen::Matrix3d> homography_of(std::span<const PlacedMarker> markers) {
  std::vector<Vector2d> on_board, in_image;
  for (const PlacedMarker& marker : markers) {
    on_board.insert(on_board.end(), marker.on_board.corners.begin(), marker.on_board.corners.end());
    in_image.insert(in_image.end(), marker.pixels.begin(), marker.pixels.end());
  }
  // Of two, a median would believe one.
  return homography_between(on_board, in_image, markers.size() > 2 ? Outliers::Some : Outliers::None);
}

Vector2d map_by(const Eigen::Matrix3d& H, const Vector2d& p) {
  return (H * p.homogeneous()).hnormalized();
}

std::vector<PlacedMarker> place_consistently(std::span<const FoundMarker> found,
                                             std::span<const BoardMarker> on_board) {
  std::vector<PlacedMarker> placed;
  for (const FoundMarker& marker : found) {
    if (marker.id >= static_cast<int>(on_board.size())) continue;
    placed.push_back({on_board[static_cast<std::size_t>(marker.id)], marker.corners});
  }
  std::vector<PlacedMarker> kept;
  for (const PlacedMarker& marker : placed) {
    const auto H = homography_of({&marker, 1});
    if (!H) continue;
    int for_it = 0, against = 0;
    for (const PlacedMarker& other : placed) {
      if (&other == &marker || !are_neighbours(marker, other)) continue;
      ++(agree(marker, *H, other) ? for_it : against);
    }
    if (for_it > against) kept.push_back(marker);
  }
  return kept;
}

}  // namespace alidade
