// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane_sums.h"

#include <cmath>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "geometry/rotation.h"

namespace alidade {
namespace {

// A direction of translation with less than this share of the strongest one's information counts as untold; rounding
// leaves 1e-15.
constexpr double kLeastShare = 1e-11;

int column_of(int i, int j) {
  constexpr int kColumns[4][4] = {{0, 1, 2, 3}, {1, 4, 5, 6}, {2, 5, 7, 8}, {3, 6, 8, 9}};
  return kColumns[i][j];
}

struct Inverse {
  Eigen::Matrix3d matrix;
  int rank;
};

Inverse pseudo_inverse(const Eigen::Matrix3d& M) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(M);
  const Eigen::Vector3d& values = solver.eigenvalues();
  Inverse inverse{Eigen::Matrix3d::Zero(), 0};
  for (int i = 0; i < 3; ++i) {
    if (!(values(i) > kLeastShare * values(2))) continue;
    const Eigen::Vector3d v = solver.eigenvectors().col(i);
    inverse.matrix += v * v.transpose() / values(i);
    ++inverse.rank;
  }
  return inverse;
}

Inverse invert(const Eigen::Matrix3d& M) {
  const double mean = M.trace() / 3.0;
  const double share = M.determinant() / (mean * mean * mean);  // at least the least eigenvalue's squared share
  if (share > 1e-5) return {M.inverse(), 3};
  return pseudo_inverse(M);
}

// How many constraints from the first on are of its point.
std::size_t length_of_run(std::span<const PlaneConstraint> constraints) {
  const Eigen::Vector3d& p = constraints.front().p_body;
  std::size_t i = 1;
  while (i < constraints.size() && constraints[i].p_body == p) ++i;
  return i;
}

// As PlaneGram::add for each, but with all sums in registers: half the time.
PlaneGram sum_of_point(std::span<const PlaneConstraint> constraints) {
  using Pair = Eigen::Array2d;
  Pair xx_yx = Pair::Zero(), zx_dx = Pair::Zero(), xy_yy = Pair::Zero(), zy_dy = Pair::Zero(), zz_dz = Pair::Zero();
  double dd = 0.0;
  for (const PlaneConstraint& constraint : constraints) {
    const Eigen::Vector3d& n = constraint.plane_world.normal;
    const double d = constraint.plane_world.offset;
    const Pair xy = constraint.weight * Pair(n.x(), n.y());
    const Pair zd = constraint.weight * Pair(n.z(), d);
    xx_yx += n.x() * xy;
    zx_dx += n.x() * zd;
    xy_yy += n.y() * xy;
    zy_dy += n.y() * zd;
    zz_dz += n.z() * zd;
    dd += d * zd.y();
  }
  PlaneGram gram;
  gram.sum.col(0) << xx_yx, zx_dx;
  gram.sum.col(1) << xy_yy, zy_dy;
  gram.sum.col(2).tail<2>() = zz_dz;
  gram.sum(3, 3) = dd;
  return gram;
}

}  // namespace

void require_planes(std::span<const PlaneConstraint> constraints) {
  for (const PlaneConstraint& constraint : constraints) {
    if (!(std::abs(constraint.plane_world.normal.squaredNorm() - 1.0) <= 1e-6)) {
      throw std::invalid_argument("a plane's normal is not of unit length");
    }
    if (!(constraint.weight > 0)) throw std::invalid_argument("a weight must be > 0");
  }
}

void PlaneSums::add(const Eigen::Vector3d& p, const PlaneGram& gram, double sign) {
  Eigen::Matrix<double, 6, 1> normals;
  normals << gram.sum.col(0).head<3>(), gram.sum.col(1).segment<2>(1), gram.sum(2, 2);
  const Eigen::Vector4d x = sign * p.homogeneous();
  normals_.leftCols<4>().noalias() += (p.x() * normals) * x.transpose();
  normals_.middleCols<3>(4).noalias() += (p.y() * normals) * x.tail<3>().transpose();
  normals_.middleCols<2>(7).noalias() += (p.z() * normals) * x.tail<2>().transpose();
  normals_.col(9) += sign * normals;
  offsets_.noalias() += gram.sum.row(3).head<3>().transpose() * x.transpose();
  squares_ += sign * gram.sum(3, 3);
}

void PlaneSums::add(const Eigen::Vector3d& p_body, const PlaneGram& gram) {
  add(p_body, gram, 1.0);
}

void PlaneSums::remove(const Eigen::Vector3d& p_body, const PlaneGram& gram) {
  add(p_body, gram, -1.0);
}

void PlaneSums::add(const PlaneConstraint& constraint) {
  PlaneGram gram;
  gram.add(constraint.plane_world, constraint.weight);
  add(constraint.p_body, gram, 1.0);
}

void PlaneSums::remove(const PlaneConstraint& constraint) {
  PlaneGram gram;
  gram.add(constraint.plane_world, constraint.weight);
  add(constraint.p_body, gram, -1.0);
}

Eigen::Matrix3d PlaneSums::normals(int i, int j) const {
  const auto& n = normals_.col(column_of(i, j));
  Eigen::Matrix3d N;
  N << n(0), n(1), n(2), n(1), n(3), n(4), n(2), n(4), n(5);
  return N;
}

PlaneSums sum_planes(std::span<const PlaneConstraint> constraints) {
  PlaneSums sums;
  while (!constraints.empty()) {
    const std::size_t run = length_of_run(constraints);
    sums.add(constraints.front().p_body, sum_of_point(constraints.first(run)));
    constraints = constraints.subspan(run);
  }
  return sums;
}

double chi2(const PlaneSums& sums, const Eigen::Isometry3d& T_world_body) {
  const Eigen::Matrix<double, 3, 4> T = T_world_body.matrix().topRows<3>();
  double sum = sums.squares() - 2.0 * T.cwiseProduct(sums.offsets()).sum();
  for (int i = 0; i < 4; ++i) {
    sum += T.col(i).dot(sums.normals(i, i) * T.col(i));
    for (int j = 0; j < i; ++j) sum += 2.0 * T.col(i).dot(sums.normals(i, j) * T.col(j));
  }
  return sum;
}

Matrix6d information(const PlaneSums& sums, const Eigen::Isometry3d& T_world_body) {
  // A plane's row is n_bodyᵀ [I, -[x]×] with n_body = Rᵀ n, and [x]× = Σ x_i [e_i]×.
  const Eigen::Matrix3d R = T_world_body.linear();
  Matrix6d H = Matrix6d::Zero();
  H.topLeftCorner<3, 3>() = R.transpose() * sums.normals(3, 3) * R;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Matrix3d E_i = skew(Eigen::Vector3d::Unit(i));
    const Eigen::Matrix3d N_i = R.transpose() * sums.normals(3, i) * R;
    H.topRightCorner<3, 3>() -= N_i * E_i;
    for (int j = 0; j < 3; ++j) {
      const Eigen::Matrix3d E_j = skew(Eigen::Vector3d::Unit(j));
      H.bottomRightCorner<3, 3>() += E_i.transpose() * (R.transpose() * sums.normals(i, j) * R) * E_j;
    }
  }
  H.bottomLeftCorner<3, 3>() = H.topRightCorner<3, 3>().transpose();
  return H;
}

double RotationCost::operator()(const Eigen::Matrix3d& R) const {
  const Eigen::Map<const Vector9d> a(R.data());
  return a.dot(G * a - 2.0 * g) + h;
}

Eigen::Vector3d RotationCost::translation(const Eigen::Matrix3d& R) const {
  const Eigen::Map<const Vector9d> a(R.data());
  return b0 - B * a;
}

RotationCost eliminate_translation(const PlaneSums& sums) {
  Eigen::Matrix<double, 3, 9> C;
  for (int i = 0; i < 3; ++i) C.middleCols<3>(3 * i) = sums.normals(3, i);
  const Inverse M = invert(sums.normals(3, 3));
  RotationCost cost;
  cost.translation_rank = M.rank;
  cost.B.noalias() = M.matrix * C;
  const Eigen::Vector3d s = sums.offsets().col(3);
  cost.b0.noalias() = M.matrix * s;
  for (int j = 0; j < 3; ++j) {
    for (int i = j; i < 3; ++i) {
      Eigen::Matrix3d block = sums.normals(i, j);
      block.noalias() -= C.middleCols<3>(3 * i).transpose() * cost.B.middleCols<3>(3 * j);
      cost.G.block<3, 3>(3 * i, 3 * j) = block;
      if (i != j) cost.G.block<3, 3>(3 * j, 3 * i) = block.transpose();
    }
    cost.g.segment<3>(3 * j) = sums.offsets().col(j);
  }
  cost.g.noalias() -= C.transpose() * cost.b0;
  cost.h = sums.squares() - s.dot(cost.b0);
  return cost;
}

}  // namespace alidade
