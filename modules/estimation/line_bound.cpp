// SPDX-License-Identifier: Apache-2.0
#include "estimation/line_bound.h"

#include <stdexcept>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "core/find_by_id.h"
#include "geometry/rotation.h"

namespace alidade {

std::optional<Eigen::Matrix<double, 1, 6>> reading_jacobian(const LineDetector& detector,
                                                            const Eigen::Isometry3d& T_world_body,
                                                            const Eigen::Vector3d& p_body) {
  const auto projection = project(detector, T_world_body * p_body);
  if (!projection) return std::nullopt;
  const Eigen::RowVector3d J_value_translation = projection->J_value_point * T_world_body.linear();
  Eigen::Matrix<double, 1, 6> J;
  J << J_value_translation, -J_value_translation * skew(p_body);
  return J;
}

Matrix6d pose_information(std::span<const LineDetector> detectors, const RigidBody& body,
                          const Eigen::Isometry3d& T_world_body, std::span<const LineReading> readings) {
  Matrix6d information = Matrix6d::Zero();
  for (const LineReading& reading : readings) {
    const BodyMarker* marker = find_by_id<BodyMarker>(body.markers, reading.marker);
    if (marker == nullptr) continue;
    const LineDetector* detector = find_by_id(detectors, reading.detector);
    if (detector == nullptr) throw std::invalid_argument(fmt::format("there is no detector {}", reading.detector));
    const double sigma = reading.sigma > 0 ? reading.sigma : detector->sigma;
    if (!(sigma > 0)) throw std::invalid_argument(fmt::format("detector {}: sigma must be > 0", detector->id));
    const auto J = reading_jacobian(*detector, T_world_body, marker->p_body);
    if (J) information += J->transpose() * *J / (sigma * sigma);
  }
  return information;
}

std::optional<PoseBound> pose_bound(const Matrix6d& information) {
  const Eigen::LDLT<Matrix6d> factor(information);
  if (factor.info() != Eigen::Success || !factor.isPositive() || factor.rcond() < 1e-14) return std::nullopt;
  const Matrix6d covariance = factor.solve(Matrix6d::Identity());
  return PoseBound{covariance.topLeftCorner<3, 3>().trace(), covariance.bottomRightCorner<3, 3>().trace()};
}

}  // namespace alidade
