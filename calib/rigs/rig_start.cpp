// SPDX-License-Identifier: Apache-2.0
#include "calib/rigs/rig_start.h"

#include <algorithm>
#include <cmath>

namespace alidade {
namespace {

// How two poses of a camera differ, in lengths of the baseline's order and rad alike; far is far.
double disagreement(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double length_m) {
  const double metres = (a.translation() - b.translation()).norm() / length_m;
  return std::min(1.0, metres + rotation_angle(a.linear().transpose() * b.linear()));
}

// The poses T_a_b that common moments give.
std::vector<Eigen::Isometry3d> pair_poses(const std::vector<PlacedBoard>& a, const std::vector<PlacedBoard>& b) {
  std::vector<Eigen::Isometry3d> poses;
  for (const PlacedBoard& in_a : a) {
    const auto in_b = std::find_if(b.begin(), b.end(), [&](const PlacedBoard& p) { return p.frame == in_a.frame; });
    if (in_b != b.end()) poses.push_back(in_a.T_camera_board * in_b->T_camera_board.inverse());
  }
  return poses;
}

Eigen::Isometry3d most_agreed(const std::vector<Eigen::Isometry3d>& poses) {
  double length_m = 1e-6;
  for (const auto& pose : poses) length_m = std::max(length_m, pose.translation().norm());
  const auto total = [&](const Eigen::Isometry3d& pose) {
    double sum = 0;
    for (const auto& other : poses) sum += disagreement(pose, other, length_m);
    return sum;
  };
  std::vector<double> sums;
  for (const auto& pose : poses) sums.push_back(total(pose));
  return poses[static_cast<std::size_t>(std::min_element(sums.begin(), sums.end()) - sums.begin())];
}

}  // namespace

std::variant<std::vector<Eigen::Isometry3d>, Untied> chain_cameras(
    std::span<const std::vector<PlacedBoard>> boards_by_camera) {
  const std::size_t count = boards_by_camera.size();
  std::vector<Eigen::Isometry3d> T_rig_camera(count, Eigen::Isometry3d::Identity());
  std::vector<bool> is_tied(count, false);
  if (count > 0) is_tied[0] = true;
  for (std::size_t step = 1; step < count; ++step) {
    std::vector<Eigen::Isometry3d> best;
    std::size_t from = 0, to = 0;
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < count; ++b) {
        if (!is_tied[a] || is_tied[b]) continue;
        auto poses = pair_poses(boards_by_camera[a], boards_by_camera[b]);
        if (poses.size() <= best.size()) continue;
        best = std::move(poses);
        from = a;
        to = b;
      }
    }
    if (best.empty()) break;
    T_rig_camera[to] = T_rig_camera[from] * most_agreed(best);
    is_tied[to] = true;
  }
  Untied untied;
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_tied[i]) untied.cameras.push_back(static_cast<int>(i));
  }
  if (!untied.cameras.empty()) return untied;
  return T_rig_camera;
}

std::vector<Eigen::Isometry3d> place_frames(std::span<const std::vector<PlacedBoard>> boards_by_camera,
                                            std::span<const Eigen::Isometry3d> T_rig_camera, int frames) {
  std::vector<Eigen::Isometry3d> T_rig_board(static_cast<std::size_t>(frames), Eigen::Isometry3d::Identity());
  std::vector<int> corners(static_cast<std::size_t>(frames), 0);
  for (std::size_t c = 0; c < boards_by_camera.size(); ++c) {
    for (const PlacedBoard& board : boards_by_camera[c]) {
      const auto frame = static_cast<std::size_t>(board.frame);
      if (board.corners <= corners[frame]) continue;
      corners[frame] = board.corners;
      T_rig_board[frame] = T_rig_camera[c] * board.T_camera_board;
    }
  }
  return T_rig_board;
}

}  // namespace alidade
