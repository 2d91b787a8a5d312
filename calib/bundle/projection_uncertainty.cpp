// SPDX-License-Identifier: Apache-2.0
#include "calib/bundle/projection_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "geometry/rotation.h"

namespace alidade {
namespace {

double median_or_1(std::vector<double> values) {
  if (values.empty()) return 1;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool counts(const BundleView& view) {
  return std::any_of(view.weights.begin(), view.weights.end(), [](double weight) { return weight > 0; });
}

// From the rig's origin; frames that no view shows stand anywhere.
double median_board_distance_m(const BundleFit& fit) {
  std::vector<double> distances;
  for (const BundleView& view : fit.views) {
    if (!counts(view)) continue;
    distances.push_back(fit.bundle.T_rig_board[static_cast<std::size_t>(view.frame)].translation().norm());
  }
  return median_or_1(std::move(distances));
}

double larger_sigma(const Eigen::Matrix2d& covariance) {
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance, Eigen::EigenvaluesOnly).eigenvalues()[1]);
}

}  // namespace

std::optional<Eigen::MatrixXd> pixel_jacobian(const BoardBundle& bundle, const BundleFreedom& freedom, int index,
                                              const Eigen::Vector2d& pixel, double distance_m) {
  const BundleCamera& of = bundle.cameras[static_cast<std::size_t>(index)];
  const auto direction = unproject(of.camera, pixel);
  if (!direction) return std::nullopt;
  const BundleLayout layout(bundle, freedom);
  const Eigen::Vector3d p = distance_m * *direction;
  const Eigen::Vector3d p_rig = of.T_rig_camera * p;
  const Eigen::Matrix<double, 2, 3> J_point =
      Eigen::Vector2d(of.camera.fx, of.camera.fy).asDiagonal() * distort(of.camera.distortion, p).J_xy_point;
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2, layout.size + 6);
  const auto J_intrinsics = intrinsics_jacobian(of.camera, p);
  for (int i = 0; const int place : layout.free_of(index)) {
    J.col(layout.intrinsics_at(index) + i++) = J_intrinsics.col(place);
  }
  if (layout.camera_poses && index > 0) {
    J.middleCols<3>(layout.pose_at(index)) = -J_point;
    J.middleCols<3>(layout.pose_at(index) + 3) = J_point * skew(p);
  }
  const Eigen::Matrix<double, 2, 3> J_rig = J_point * of.T_rig_camera.linear().transpose();
  J.middleCols<3>(layout.size) = J_rig;
  J.middleCols<3>(layout.size + 3) = -J_rig * skew(p_rig);
  return J;
}

std::vector<Eigen::MatrixXd> pixel_jacobians(const BundleFit& fit, const BundleFreedom& freedom) {
  constexpr int kPlaces = 5;
  const double distance_m = median_board_distance_m(fit);
  std::vector<Eigen::MatrixXd> all;
  for (std::size_t c = 0; c < fit.bundle.cameras.size(); ++c) {
    const Camera& camera = fit.bundle.cameras[c].camera;
    for (int row = 0; row < kPlaces; ++row) {
      for (int column = 0; column < kPlaces; ++column) {
        const Eigen::Vector2d pixel((column + 0.5) * camera.width / kPlaces, (row + 0.5) * camera.height / kPlaces);
        auto J = pixel_jacobian(fit.bundle, freedom, static_cast<int>(c), pixel, distance_m);
        if (J) all.push_back(std::move(*J));
      }
    }
  }
  return all;
}

std::optional<Eigen::Matrix2d> pixel_covariance(const BundleCovariance& covariance, const BoardBundle& bundle,
                                                const BundleFreedom& freedom, int index, const Eigen::Vector2d& pixel,
                                                double distance_m) {
  const auto J = pixel_jacobian(bundle, freedom, index, pixel, distance_m);
  if (!J) return std::nullopt;
  return *J * covariance.shared_and_motion * J->transpose();
}

double median_distance_m(const BundleFit& fit, const BoardShape& shape, int index) {
  const Eigen::Vector3d centre = 0.5 * (shape.corners_m.front() + shape.corners_m.back());
  const Eigen::Isometry3d T_camera_rig = fit.bundle.cameras[static_cast<std::size_t>(index)].T_rig_camera.inverse();
  std::vector<double> distances;
  for (const BundleView& view : fit.views) {
    if (view.camera != index || !counts(view)) continue;
    distances.push_back(
        (T_camera_rig * (fit.bundle.T_rig_board[static_cast<std::size_t>(view.frame)] * centre)).norm());
  }
  return median_or_1(std::move(distances));
}

UncertaintyMap uncertainty_map(const BundleCovariance& covariance, const BoardBundle& bundle,
                               const BundleFreedom& freedom, int index, double distance_m, int columns) {
  const Camera& camera = bundle.cameras[static_cast<std::size_t>(index)].camera;
  UncertaintyMap map;
  map.columns = columns;
  map.step_px = (camera.width - 1.0) / (columns - 1);
  map.rows = 1 + static_cast<int>(std::floor((camera.height - 1.0) / map.step_px));
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto C =
          pixel_covariance(covariance, bundle, freedom, index, map.step_px * Eigen::Vector2d(column, row), distance_m);
      map.sigma_px.push_back(C ? larger_sigma(*C) : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return map;
}

}  // namespace alidade
