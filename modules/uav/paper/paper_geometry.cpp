// SPDX-License-Identifier: Apache-2.0
#include "uav/paper/paper_geometry.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "geometry/tangent.h"

namespace alidade {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Index = Eigen::Index;

constexpr double kParallel_rad = 1e-6;
constexpr double kGreatestCondition = 1e4;  // above it 0.1 m of noise are 1 km of error
constexpr double kUnknown = 1e4;            // m, m/s, m/s²: the standard deviation of what is not determined

void require_valid(const Bearing& bearing) {
  if (!(std::abs(bearing.direction_world.norm() - 1.0) <= 1e-6)) {
    throw std::invalid_argument("a bearing's direction is not of unit length");
  }
  if (!bearing.origin_world.allFinite()) throw std::invalid_argument("a bearing's origin is not finite");
  if (!bearing.covariance.allFinite()) throw std::invalid_argument("a bearing's covariance is not finite");
}

// How far the end of the line of sight moves with the direction's two errors.
Eigen::Matrix<double, 3, 2> lever(const Bearing& bearing, double range_m) {
  return range_m * tangent_basis(bearing.direction_world);
}

double seconds_after(const Bearing& first, const Bearing& other) {
  return to_seconds(other.time - first.time);
}

Index unknowns_of(PaperMotion motion) {
  return 3 * static_cast<Index>(motion);
}

// A X = B of eq. 10; X: ranges, then velocity, then acceleration.
struct Conjugation {
  MatrixXd A;
  VectorXd B;
};

Conjugation conjugation_of(std::span<const Bearing> bearings, PaperMotion motion) {
  const Index n = static_cast<Index>(bearings.size()), columns = n + unknowns_of(motion);
  Conjugation system{MatrixXd::Zero(3 * (n - 1), columns), VectorXd(3 * (n - 1))};
  for (Index k = 1; k < n; ++k) {
    const Bearing& other = bearings[static_cast<std::size_t>(k)];
    const double dt = seconds_after(bearings[0], other);
    auto rows = system.A.middleRows<3>(3 * (k - 1));
    rows.col(0) = bearings[0].direction_world;
    rows.col(k) = -other.direction_world;
    if (motion != PaperMotion::Still) rows.middleCols<3>(n).diagonal().setConstant(dt);
    if (motion == PaperMotion::Acceleration) rows.rightCols<3>().diagonal().setConstant(0.5 * dt * dt);
    system.B.segment<3>(3 * (k - 1)) = other.origin_world - bearings[0].origin_world;
  }
  return system;
}

struct PseudoInverse {
  MatrixXd A_plus, null_space;  // the columns of null_space are not determined
  double condition;
};

PseudoInverse invert(const MatrixXd& A) {
  const Eigen::JacobiSVD<MatrixXd> svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VectorXd& s = svd.singularValues();
  Index rank = 0;
  while (rank < s.size() && s[rank] * kGreatestCondition > s[0]) ++rank;
  const double least = s[s.size() - 1];
  return {svd.matrixV().leftCols(rank) * s.head(rank).cwiseInverse().asDiagonal() *
              svd.matrixU().leftCols(rank).transpose(),
          svd.matrixV().rightCols(s.size() - rank), least > 0 ? s[0] / least : std::numeric_limits<double>::infinity()};
}

// Errors of directions make the equations err by e_k = r₁ δa₁ − r_k δa_k, and move the point itself across a₁.
Matrix9d covariance_of(std::span<const Bearing> bearings, const VectorXd& X, const PseudoInverse& inverse) {
  const Index n = static_cast<Index>(bearings.size()), motion = X.size() - n;
  MatrixXd G = MatrixXd::Zero(3 * (n - 1), 2 * n), noise = MatrixXd::Zero(2 * n, 2 * n);
  for (Index k = 0; k < n; ++k) {
    const Bearing& bearing = bearings[static_cast<std::size_t>(k)];
    noise.block<2, 2>(2 * k, 2 * k) = bearing.covariance;
    for (Index row = 0; k == 0 && row < n - 1; ++row) G.block<3, 2>(3 * row, 0) = lever(bearing, X[0]);
    if (k > 0) G.block<3, 2>(3 * (k - 1), 2 * k) = -lever(bearing, X[k]);
  }
  const Vector3d& a1 = bearings[0].direction_world;
  MatrixXd J_state_X = MatrixXd::Zero(9, X.size());
  J_state_X.topLeftCorner<3, 1>() = a1;
  J_state_X.block(3, n, motion, motion).setIdentity();
  MatrixXd J = -J_state_X * inverse.A_plus * G;
  J.topLeftCorner<3, 2>() += lever(bearings[0], X[0]);
  const MatrixXd unknown = kUnknown * J_state_X * inverse.null_space;
  return J * noise * J.transpose() + unknown * unknown.transpose();
}

}  // namespace

std::optional<PairFix> solve_pair(const Bearing& first, const Bearing& second, const Vector3d& displacement_m) {
  require_valid(first);
  require_valid(second);
  const Vector3d &a1 = first.direction_world, &a2 = second.direction_world;
  const Vector3d b = second.origin_world - first.origin_world - displacement_m;
  const Vector3d across = a1.cross(a2);
  const double c = a1.dot(a2), sine2 = across.squaredNorm();
  if (!(sine2 > kParallel_rad * kParallel_rad)) return std::nullopt;
  PairFix fix;
  fix.r1_m = (a1.dot(b) - c * a2.dot(b)) / sine2;  // eq. 8
  fix.r2_m = (c * a1.dot(b) - a2.dot(b)) / sine2;
  fix.residual_m2 = std::pow(b.dot(across), 2) / sine2;  // eq. 9
  fix.angle_rad = std::atan2(std::sqrt(sine2), std::abs(c));
  fix.p_world = first.origin_world + fix.r1_m * a1;
  const Eigen::RowVector3d first_row = (a1 - c * a2).transpose() / sine2;  // of (AᵀA)⁻¹Aᵀ
  const Eigen::Matrix<double, 3, 2> J1 = (Matrix3d::Identity() - a1 * first_row) * lever(first, fix.r1_m);
  const Eigen::Matrix<double, 3, 2> J2 = a1 * first_row * lever(second, fix.r2_m);
  fix.covariance_world = J1 * first.covariance * J1.transpose() + J2 * second.covariance * J2.transpose();
  return fix;
}

int least_bearings(PaperMotion motion) {
  return motion == PaperMotion::Still ? 2 : motion == PaperMotion::Velocity ? 3 : 5;
}

std::optional<PaperFix> solve_conjugation(std::span<const Bearing> bearings, PaperMotion motion) {
  for (const Bearing& bearing : bearings) require_valid(bearing);
  if (bearings.size() < static_cast<std::size_t>(least_bearings(motion))) return std::nullopt;
  const Index n = static_cast<Index>(bearings.size());
  const Conjugation system = conjugation_of(bearings, motion);
  const PseudoInverse inverse = invert(system.A);
  const VectorXd X = inverse.A_plus * system.B;  // eq. 11
  PaperFix fix;
  fix.state.time = bearings[0].time;
  fix.state.p_world = bearings[0].origin_world + X[0] * bearings[0].direction_world;
  if (motion != PaperMotion::Still) fix.state.v_world = X.segment<3>(n);
  if (motion == PaperMotion::Acceleration) fix.state.a_world = X.tail<3>();
  fix.state.covariance = covariance_of(bearings, X, inverse);
  fix.ranges_m.assign(X.data(), X.data() + n);
  fix.residual_m2 = (system.A * X - system.B).squaredNorm();
  fix.condition = inverse.condition;
  fix.is_ill_conditioned = inverse.null_space.cols() > 0;
  return fix;
}

std::optional<PaperFix> solve_in_two_steps(std::span<const Bearing> bearings, PaperMotion motion) {
  auto fix = solve_conjugation(bearings, motion);
  if (!fix || (bearings.size() > 3 && !fix->is_ill_conditioned)) return fix;
  const double dt = seconds_after(bearings[0], bearings[1]);
  const Vector3d displacement_m = fix->state.v_world * dt + fix->state.a_world * (0.5 * dt * dt);  // eq. 5
  const auto pair = solve_pair(bearings[0], bearings[1], displacement_m);
  if (!pair) return fix;
  fix->state.p_world = pair->p_world;
  fix->ranges_m[0] = pair->r1_m;
  fix->ranges_m[1] = pair->r2_m;
  return fix;
}

}  // namespace alidade
