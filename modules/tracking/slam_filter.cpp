// SPDX-License-Identifier: Apache-2.0
#include "tracking/slam_filter.h"

#include <stdexcept>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "geometry/rotation.h"

namespace alidade {
namespace {

constexpr int kCamera = 12;
using Matrix12d = Eigen::Matrix<double, kCamera, kCamera>;

Eigen::Index row_of(int point) {
  return kCamera + 3 * static_cast<Eigen::Index>(point);
}

// M P Mᵀ, where M moves the first rows and columns of P and leaves the others; exactly symmetric.
template <int kSize>
void transform_head(Eigen::MatrixXd& P, const Eigen::Matrix<double, kSize, kSize>& M) {
  P.topRows<kSize>() = (M * P.topRows<kSize>()).eval();
  const Eigen::Matrix<double, kSize, kSize> head = P.topLeftCorner<kSize, kSize>() * M.transpose();
  P.leftCols<kSize>() = P.topRows<kSize>().transpose().eval();
  P.topLeftCorner<kSize, kSize>() = 0.5 * (head + head.transpose());
}

void move_by(SlamState& state, const Eigen::VectorXd& error) {
  Vector18d of_camera = Vector18d::Zero();
  of_camera.head<kCamera>() = error.head<kCamera>();
  state.camera = moved_by(state.camera, of_camera);
  for (std::size_t j = 0; j < state.points.size(); ++j) {
    state.points[j] += error.segment<3>(row_of(static_cast<int>(j)));
  }
  // The pose's error is counted from the new pose, along its axes.
  Matrix6d reset = Matrix6d::Zero();
  reset.topLeftCorner<3, 3>() = exp_so3(error.segment<3>(3)).transpose();
  reset.bottomRightCorner<3, 3>() = right_jacobian_so3(error.segment<3>(3));
  transform_head<6>(state.covariance, reset);
}

}  // namespace

SlamState slam_state(const MotionState& camera) {
  SlamState state{camera, {}, camera.covariance.topLeftCorner<kCamera, kCamera>()};
  state.camera.a_world.setZero();
  state.camera.alpha_body.setZero();
  state.camera.covariance.setZero();
  return state;
}

MotionState camera_of(const SlamState& state) {
  MotionState camera = state.camera;
  camera.covariance.topLeftCorner<kCamera, kCamera>() = state.covariance.topLeftCorner<kCamera, kCamera>();
  return camera;
}

SlamState with_points(SlamState state, std::span<const SlamPoint> points) {
  const Eigen::Index before = state.covariance.rows();
  const Eigen::Index after = before + 3 * static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(after, after);
  P.topLeftCorner(before, before) = state.covariance;
  for (const SlamPoint& point : points) {
    const Eigen::Index row = row_of(static_cast<int>(state.points.size()));
    P.block<3, 3>(row, row) = point.covariance_world;
    if (point.cross.rows() == before) {
      P.block(0, row, before, 3) = point.cross;
      P.block(row, 0, 3, before) = point.cross.transpose();
    } else if (point.cross.rows() != 0) {
      throw std::invalid_argument(fmt::format("cross must have {} rows, got {}", before, point.cross.rows()));
    }
    state.points.push_back(point.p_world);
  }
  state.covariance = std::move(P);
  return state;
}

SlamState with_only_points(const SlamState& state, std::span<const int> kept) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < kCamera; ++i) rows.push_back(i);
  SlamState smaller{state.camera, {}, {}};
  for (int point : kept) {
    smaller.points.push_back(state.points.at(static_cast<std::size_t>(point)));
    for (Eigen::Index i = 0; i < 3; ++i) rows.push_back(row_of(point) + i);
  }
  smaller.covariance = state.covariance(rows, rows);
  return smaller;
}

SlamState predict(const SlamState& state, Timestamp time, const MotionNoise& noise) {
  SlamState next = state;
  next.camera = predict_without_noise(state.camera, time);
  const Matrix12d F = transition_jacobian(state.camera, next.camera).topLeftCorner<kCamera, kCamera>();
  transform_head<kCamera>(next.covariance, F);
  next.covariance.topLeftCorner<kCamera, kCamera>() +=
      noise_covariance(state.camera, next.camera, noise).topLeftCorner<kCamera, kCamera>();
  return next;
}

std::optional<SlamMeasurement> expected_measurement(const Camera& camera, const SlamState& state, int point) {
  const Eigen::Isometry3d T_camera_world = state.camera.T_world_body.inverse();
  const Eigen::Vector3d p_camera = T_camera_world * state.points.at(static_cast<std::size_t>(point));
  const auto projection = project(camera, p_camera);
  if (!projection) return std::nullopt;
  Eigen::Matrix<double, 3, 9> J;
  J << -Eigen::Matrix3d::Identity(), skew(p_camera), T_camera_world.linear();
  return SlamMeasurement{projection->pixel, projection->J_pixel_point * J};
}

SlamState update_slam_filter(const Camera& camera, const SlamState& predicted,
                             std::span<const SlamSighting> sightings) {
  struct Row {
    const SlamSighting* sighting;
    SlamMeasurement expected;
  };
  std::vector<Row> rows;
  for (const SlamSighting& s : sightings) {
    if (const auto expected = expected_measurement(camera, predicted, s.point)) rows.push_back({&s, *expected});
  }
  if (rows.empty()) return predicted;
  const auto n = 2 * static_cast<Eigen::Index>(rows.size());
  const Eigen::MatrixXd& P = predicted.covariance;
  Eigen::MatrixXd PHt(P.rows(), n), S(n, n);
  Eigen::VectorXd innovation(n);
  for (Eigen::Index k = 0; k < n; k += 2) {
    const auto& [s, expected] = rows[static_cast<std::size_t>(k / 2)];
    PHt.middleCols<2>(k) = P.leftCols<6>() * expected.H.leftCols<6>().transpose() +
                           P.middleCols<3>(row_of(s->point)) * expected.H.rightCols<3>().transpose();
    innovation.segment<2>(k) = s->pixel - expected.pixel;
  }
  for (Eigen::Index k = 0; k < n; k += 2) {
    const auto& [s, expected] = rows[static_cast<std::size_t>(k / 2)];
    S.middleRows<2>(k) =
        expected.H.leftCols<6>() * PHt.topRows<6>() + expected.H.rightCols<3>() * PHt.middleRows<3>(row_of(s->point));
    S.block<2, 2>(k, k) += s->sigma_px * s->sigma_px * Eigen::Matrix2d::Identity();
  }
  // P - P Hᵀ S⁻¹ H P as P - W Wᵀ, W = P Hᵀ L⁻ᵀ: it stays symmetric.
  const Eigen::LLT<Eigen::MatrixXd> factor(S);
  const Eigen::MatrixXd Wt = factor.matrixL().solve(PHt.transpose());
  SlamState state = predicted;
  state.covariance.selfadjointView<Eigen::Lower>().rankUpdate(Wt.transpose(), -1.0);
  state.covariance.triangularView<Eigen::StrictlyUpper>() = state.covariance.transpose();
  move_by(state, Wt.transpose() * factor.matrixL().solve(innovation));
  return state;
}

}  // namespace alidade
