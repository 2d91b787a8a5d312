// SPDX-License-Identifier: Apache-2.0
#include "reconstruction/bundle_covariance.h"

#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "geometry/rotation.h"

namespace alidade {
namespace {

using Matrix63d = Eigen::Matrix<double, 6, 3>;

// What one point knows of itself (V) and shares with the poses that see it (W).
struct PointBlock {
  Eigen::Matrix3d V = Eigen::Matrix3d::Zero();
  std::vector<std::pair<int, Matrix63d>> W;  // column of the pose, ∂²/∂pose∂point
  int sightings = 0;
};

struct NormalMatrix {
  std::vector<int> column_of_keyframe;  // first column in U, or -1
  Eigen::MatrixXd U;
  std::vector<PointBlock> points;
};

NormalMatrix assemble(const Camera& camera, const PointMap& map, const BundleOptions& options) {
  NormalMatrix N;
  N.column_of_keyframe.assign(map.keyframes.size(), -1);
  int columns = 0;
  for (int k : options.free_keyframes) {
    N.column_of_keyframe[static_cast<std::size_t>(k)] = columns;
    columns += 6;
  }
  N.U = Eigen::MatrixXd::Zero(columns, columns);
  N.points.resize(map.points.size());
  for (const auto* list : {&options.free_keyframes, &options.fixed_keyframes}) {
    for (int k : *list) {
      const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(k)];
      const int column = N.column_of_keyframe[static_cast<std::size_t>(k)];
      const Eigen::Isometry3d T_camera_world = keyframe.T_world_camera.inverse();
      for (const Sighting& s : keyframe.sightings) {
        const Eigen::Vector3d p_camera = T_camera_world * map.points[static_cast<std::size_t>(s.point)].p_world;
        const auto projection = project(camera, p_camera);
        if (!projection) continue;
        const Eigen::Matrix<double, 2, 3> J = projection->J_pixel_point / s.sigma_px;
        const Eigen::Matrix<double, 2, 3> J_X = J * T_camera_world.linear();
        PointBlock& block = N.points[static_cast<std::size_t>(s.point)];
        block.V += J_X.transpose() * J_X;
        ++block.sightings;
        if (column < 0) continue;
        Eigen::Matrix<double, 2, 6> J_T;
        J_T << -J, J * skew(p_camera);
        N.U.block<6, 6>(column, column) += J_T.transpose() * J_T;
        block.W.emplace_back(column, J_T.transpose() * J_X);
      }
    }
  }
  return N;
}

// Without a second fixed pose the scale floats: hold the farthest free keyframe's distance to the first keyframe.
void hold_scale(NormalMatrix& N, const PointMap& map, const BundleOptions& options) {
  if (options.fixed_keyframes.size() >= 2 || options.free_keyframes.empty()) return;
  const int anchor = options.fixed_keyframes.empty() ? options.free_keyframes.front() : options.fixed_keyframes.front();
  const auto pose = [&](int k) -> const Eigen::Isometry3d& {
    return map.keyframes[static_cast<std::size_t>(k)].T_world_camera;
  };
  int farthest = options.free_keyframes.front();
  double distance = 0;
  for (int k : options.free_keyframes) {
    const double d = (pose(k).translation() - pose(anchor).translation()).norm();
    if (d > distance) {
      distance = d;
      farthest = k;
    }
  }
  if (!(distance > 0)) return;
  const Eigen::Vector3d along =
      pose(farthest).linear().transpose() * (pose(farthest).translation() - pose(anchor).translation()) / distance;
  const double information = 1e12 / (distance * distance);
  const int column = N.column_of_keyframe[static_cast<std::size_t>(farthest)];
  N.U.block<3, 3>(column, column) += information * along * along.transpose();
  if (options.fixed_keyframes.empty()) {
    const int first = N.column_of_keyframe[static_cast<std::size_t>(anchor)];
    N.U.block<6, 6>(first, first) += information * Matrix6d::Identity();
  }
}

}  // namespace

PointMap with_covariances(const Camera& camera, PointMap map, const BundleOptions& options) {
  NormalMatrix N = assemble(camera, map, options);
  hold_scale(N, map, options);
  Eigen::MatrixXd S = N.U;
  std::vector<Eigen::Matrix3d> V_inverse(N.points.size(), Eigen::Matrix3d::Zero());
  for (std::size_t i = 0; i < N.points.size(); ++i) {
    const PointBlock& point = N.points[i];
    if (point.sightings < 2) continue;
    V_inverse[i] = point.V.inverse();
    for (const auto& [row, W_row] : point.W) {
      const Matrix63d weighted = W_row * V_inverse[i];
      for (const auto& [column, W_column] : point.W) S.block<6, 6>(row, column) -= weighted * W_column.transpose();
    }
  }
  const Eigen::MatrixXd C = S.ldlt().solve(Eigen::MatrixXd::Identity(S.rows(), S.cols()));
  if (!C.allFinite()) return map;

  for (int k : options.free_keyframes) {
    const int column = N.column_of_keyframe[static_cast<std::size_t>(k)];
    map.keyframes[static_cast<std::size_t>(k)].covariance = C.block<6, 6>(column, column);
  }
  for (std::size_t i = 0; i < N.points.size(); ++i) {
    const PointBlock& point = N.points[i];
    if (point.sightings < 2 || point.W.empty()) continue;
    Eigen::Matrix3d spread = point.V;
    for (const auto& [row, W_row] : point.W) {
      for (const auto& [column, W_column] : point.W) {
        spread += W_row.transpose() * C.block<6, 6>(row, column) * W_column;
      }
    }
    map.points[i].covariance_world = V_inverse[i] * spread * V_inverse[i];
  }
  return map;
}

}  // namespace alidade
