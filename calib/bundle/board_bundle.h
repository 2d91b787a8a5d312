// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "calib/boards/board.h"
#include "calib/boards/board_view.h"
#include "camera/camera.h"
#include "geometry/pose.h"

namespace alidade {

/// How a board differs from the flat and regular one that it should be: it bulges towards z by
/// x (1 - u²) + y (1 - v²), where u and v run from -1 to 1 across its corners (source: mrcal, "calobject warp"), and
/// every corner may lie off by itself (source: Strobl and Hirzinger 2011, "more accurate pinhole camera calibration
/// with imperfect planar target").
struct BoardWarp {
  double x_m = 0, y_m = 0;
  std::vector<Eigen::Vector3d> offsets_m{};  ///< of every corner; empty: none
};

/// The corners of a bulging board in its frame, m, and what a bulge of 1 moves each of them in z.
struct BoardShape {
  std::vector<Eigen::Vector3d> corners_m;
  std::vector<Eigen::Vector2d> bulge;  ///< (1 - u², 1 - v²)
  double extent_m = 0;                 ///< the diagonal
  /// What offsets of the corners together may not do, as orthonormal columns: move, turn or scale the whole board.
  Eigen::Matrix<double, Eigen::Dynamic, 7> rigid_modes{};

  Eigen::Vector3d corner(int id, const BoardWarp& warp) const {
    const auto i = static_cast<std::size_t>(id);
    const Eigen::Vector3d bulging =
        corners_m[i] + Eigen::Vector3d(0, 0, bulge[i].x() * warp.x_m + bulge[i].y() * warp.y_m);
    return warp.offsets_m.empty() ? bulging : Eigen::Vector3d(bulging + warp.offsets_m[i]);
  }
};

BoardShape shape_of(const Board& board);

/// A camera of a bundle and where it stands.
struct BundleCamera {
  Camera camera;
  Eigen::Isometry3d T_rig_camera = Eigen::Isometry3d::Identity();
};

/// What one camera sees of the board at one moment; `weights` (0 to 1, one per corner) say how far each is trusted.
struct BundleView {
  int camera = 0;
  int frame = 0;
  std::vector<BoardCorner> corners;
  std::vector<double> weights;
};

/// All that is estimated together: cameras, the board at every moment, and its shape. The rig is camera 0's frame.
struct BoardBundle {
  std::vector<BundleCamera> cameras;
  std::vector<Eigen::Isometry3d> T_rig_board;
  BoardWarp warp;
};

struct BundleFreedom {
  /// Places in intrinsics() that are found, by camera; a camera that is left out or whose list is empty stands.
  std::vector<std::vector<int>> intrinsics;
  bool camera_poses = true;  ///< of all cameras but the first
  bool warp = true;
  bool corners = false;               ///< every corner's place, instead of the warp
  double warp_sigma_share = 0.005;    ///< boards are flat to this share of their diagonal: holds what nothing else does
  double corner_sigma_share = 0.002;  ///< along the board corners lie where they should to this share of it
};

/// Where the parameters that all moments share stand in their vector.
struct BundleLayout {
  BundleLayout(const BoardBundle& bundle, const BundleFreedom& freedom);

  int intrinsics_at(int camera) const { return starts[static_cast<std::size_t>(camera)]; }
  const std::vector<int>& free_of(int camera) const { return intrinsics[static_cast<std::size_t>(camera)]; }
  int pose_at(int camera) const { return pose_start + 6 * (camera - 1); }  ///< camera >= 1

  std::vector<std::vector<int>> intrinsics;  ///< by camera
  std::vector<int> starts;                   ///< of their places
  int pose_start = 0;
  int warp_at = 0;
  int corners_at = 0;  ///< three of each corner
  int size = 0;
  bool camera_poses = false, warp = false, corners = false;
};

/// The normal equations of all views about a bundle, weighted by 1/sigma_px² and the corners' weights: H x = -g for the
/// shared parameters and the six of every frame (xi of T_rig_board * exp(xi)); frames only meet in the shared ones.
struct BundleEquations {
  Eigen::MatrixXd H;  ///< shared
  Eigen::VectorXd g;
  std::vector<Matrix6d> H_frame;
  std::vector<Vector6d> g_frame;
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>> H_frame_shared;
  double cost = 0;  ///< sum of squares, weighted
};

/// Throws std::invalid_argument for views of cameras, frames or corners that do not exist.
BundleEquations bundle_equations(const BoardBundle& bundle, const BoardShape& shape, std::span<const BundleView> views,
                                 const BundleFreedom& freedom);

/// The weighted sum of squares alone, priors included.
double bundle_cost(const BoardBundle& bundle, const BoardShape& shape, std::span<const BundleView> views,
                   const BundleFreedom& freedom);

/// Found minus seen of every corner of a view, px; 1000 px for one that is not in front of the camera.
std::vector<Eigen::Vector2d> residuals_px(const BoardBundle& bundle, const BoardShape& shape, const BundleView& view);

struct BundleSolution {
  BoardBundle bundle;
  double cost = 0;
  int iterations = 0;
  bool converged = false;
};

struct BundleSolverOptions {
  int max_iterations = 100;
  double relative_tolerance = 1e-9;  ///< a step that would lower the cost by less of it is the last
};

/// The bundle of least weighted squares from a start near it: Levenberg and Marquardt's steps, the frames eliminated by
/// Schur's complement. Deterministic.
BundleSolution solve_bundle(BoardBundle start, const BoardShape& shape, std::span<const BundleView> views,
                            const BundleFreedom& freedom, const BundleSolverOptions& options = {});

}  // namespace alidade
