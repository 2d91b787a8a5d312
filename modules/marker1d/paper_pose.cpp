// SPDX-License-Identifier: Apache-2.0
#include "marker1d/paper_pose.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "marker1d/paper_rotation.h"

namespace alidade {
namespace {

using Vector9 = Eigen::Matrix<double, 9, 1>;

constexpr double kReferenceAgain = 0.6;  // |P|²; near 1, dA/dP grows without bound

Vector9 vec(const Eigen::Matrix3d& A) {
  return Eigen::Map<const Vector9>(A.data());
}

// Rotations that take the axes into each other.
std::array<Eigen::Matrix3d, 24> cube_rotations() {
  std::array<Eigen::Matrix3d, 24> rotations;
  std::size_t count = 0;
  for (int x = 0; x < 6; ++x) {
    for (int y = 0; y < 6; ++y) {
      if (x % 3 == y % 3) continue;
      const Eigen::Vector3d u = (x < 3 ? 1 : -1) * Eigen::Vector3d::Unit(x % 3);
      const Eigen::Vector3d v = (y < 3 ? 1 : -1) * Eigen::Vector3d::Unit(y % 3);
      rotations[count++] << u, v, u.cross(v);
    }
  }
  return rotations;
}

// The end of a step: no farther than where the reference is changed.
Eigen::Vector3d shortened(const Eigen::Vector3d& P) {
  const double square = P.squaredNorm();
  constexpr double kEnd = kReferenceAgain + 0.01;
  return square > kEnd ? Eigen::Vector3d(std::sqrt(kEnd / square) * P) : P;
}

}  // namespace

void PaperSums::add(const MarkerPlane& plane, double weight) {
  const Plane& world = plane.plane_world;
  const Eigen::Vector4d y(world.normal.x(), world.normal.y(), world.normal.z(),
                          world.normal.dot(origin_world_) - world.offset);
  grams_[static_cast<std::size_t>(plane.marker)].noalias() += (weight * y) * y.transpose();
}

double PaperCost::operator()(const Eigen::Matrix3d& A) const {
  const Vector9 a = vec(A);
  return a.dot(G * a) - 2.0 * g.dot(a) + h;
}

Eigen::Vector3d PaperCost::translation(const Eigen::Matrix3d& A) const {
  return b0 - B * vec(A);
}

std::optional<PaperCost> eliminate_translation(const PaperSums& sums) {
  // k = X ⊗ n, so that K, C and l are made of each marker's Σ w n nᵀ and Σ w d n.
  Eigen::Matrix<double, 9, 9> K = Eigen::Matrix<double, 9, 9>::Zero();
  Eigen::Matrix<double, 3, 9> C = Eigen::Matrix<double, 3, 9>::Zero();
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  Eigen::Vector3d s = Eigen::Vector3d::Zero();
  Vector9 l = Vector9::Zero();
  double dd = 0.0;
  for (std::size_t i = 0; i < sums.body().markers.size(); ++i) {
    const Eigen::Vector3d& X = sums.body().markers[i].p_body;
    const Eigen::Matrix3d N = sums.gram(i).topLeftCorner<3, 3>();
    const Eigen::Vector3d wdn = -sums.gram(i).topRightCorner<3, 1>();
    M += N;
    s += wdn;
    dd += sums.gram(i)(3, 3);
    for (int c = 0; c < 3; ++c) {
      C.middleCols<3>(3 * c) += X(c) * N;
      l.segment<3>(3 * c) += X(c) * wdn;
      for (int r = 0; r < 3; ++r) K.block<3, 3>(3 * r, 3 * c) += (X(r) * X(c)) * N;
    }
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  const Eigen::Vector3d spread = eigen.computeDirect(M, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(spread(0) > 1e-12 * spread(2))) return std::nullopt;
  PaperCost cost;
  const Eigen::Matrix3d M_inverse = M.inverse();
  cost.B = M_inverse * C;
  const Eigen::Vector3d b = M_inverse * s;
  cost.b0 = b + sums.origin_world();
  cost.G = K - C.transpose() * cost.B;
  cost.g = l - C.transpose() * b;
  cost.h = dd - s.dot(b);
  cost.spread = spread(0) / spread(2);
  return cost;
}

PaperEquations paper_equations(const PaperCost& cost, const Eigen::Vector3d& P, const Eigen::Matrix3d& A_ref) {
  const PaperRotation rotation = differentiate_paper_rotation(P);
  Eigen::Matrix<double, 9, 3> a_j;
  for (int j = 0; j < 3; ++j) a_j.col(j) = vec(rotation.A_j[j] * A_ref);
  const Vector9 slope = cost.G * vec(rotation.A * A_ref) - cost.g;
  PaperEquations equations;
  equations.f = a_j.transpose() * slope;
  equations.J = a_j.transpose() * (cost.G * a_j);
  // a_jkᵀ slope, with A_ref on the other side: the slope is turned back once instead of six A_jk forth.
  const Eigen::Matrix3d turned = Eigen::Map<const Eigen::Matrix3d>(slope.data()) * A_ref.transpose();
  for (int j = 0; j < 3; ++j) {
    for (int k = 0; k < 3; ++k) equations.J(j, k) += rotation.A_jk[j][k].cwiseProduct(turned).sum();
  }
  return equations;
}

std::optional<PaperPose> solve_paper_pose(const PaperCost& cost, const Eigen::Matrix3d& R_world_body_start,
                                          const PaperPoseOptions& options) {
  Eigen::Matrix3d A_ref = R_world_body_start;
  Eigen::Vector3d P = Eigen::Vector3d::Zero();
  for (int step = 1; step <= options.max_steps; ++step) {
    const PaperEquations equations = paper_equations(cost, P, A_ref);
    const Eigen::Matrix3d& J = equations.J;
    const double det = J.determinant(), size = J.norm();
    if (!(std::abs(det) > 1e-13 * size * size * size)) return std::nullopt;
    const Eigen::Vector3d change = -(J.inverse() * equations.f);
    P = shortened(P + change);
    if (change.norm() < options.last_step) {
      PaperPose pose;
      // Products of millions of frames would cease to be rotations.
      pose.T_world_body.linear() = Eigen::Quaterniond(paper_rotation(P) * A_ref).normalized().toRotationMatrix();
      pose.T_world_body.translation() = cost.translation(pose.T_world_body.linear());
      pose.steps = step;
      pose.is_minimum = det > 0 && J(0, 0) > 0 && J(0, 0) * J(1, 1) > J(0, 1) * J(1, 0);
      return pose;
    }
    if (P.squaredNorm() > kReferenceAgain) {
      A_ref = (paper_rotation(P) * A_ref).eval();
      P.setZero();
    }
  }
  return std::nullopt;
}

std::optional<PaperPose> start_paper_pose(const PaperCost& cost, const PaperPoseOptions& options) {
  static const std::array<Eigen::Matrix3d, 24> starts = cube_rotations();
  std::optional<PaperPose> best;
  double least = 0.0;
  for (const Eigen::Matrix3d& start : starts) {
    const auto pose = solve_paper_pose(cost, start, options);
    if (!pose || !pose->is_minimum) continue;
    const double E = cost(pose->T_world_body.linear());
    if (best && !(E < least)) continue;
    best = pose;
    least = E;
  }
  return best;
}

}  // namespace alidade
