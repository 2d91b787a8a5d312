// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/plane_constraint.h"
#include "geometry/pose.h"

namespace alidade {

// Planes enter a rigid transform only through sums over them, so that a step of a solver costs the same for 12 planes
// as for 1200, and a plane is taken back as easily as it was added. Source: marker1d paper page, "The Gram trick".

/// Σ w (n, d)(n, d)ᵀ over planes n · p = d: all that they say of one point, which lies in them.
struct PlaneGram {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();  ///< lower triangle; what is above it is not kept

  void add(const Plane& plane, double weight) {
    const Eigen::Vector2d xy = weight * plane.normal.head<2>();
    const Eigen::Vector2d zd(weight * plane.normal.z(), weight * plane.offset);
    sum.col(0).head<2>() += plane.normal.x() * xy;
    sum.col(0).tail<2>() += plane.normal.x() * zd;
    sum.col(1).head<2>() += plane.normal.y() * xy;
    sum.col(1).tail<2>() += plane.normal.y() * zd;
    sum.col(2).tail<2>() += plane.normal.z() * zd;
    sum(3, 3) += plane.offset * zd.y();
  }
  void remove(const Plane& plane, double weight) { add(plane, -weight); }

  /// Σ w (n · p - d)².
  double cost(const Eigen::Vector3d& p_world) const {
    const Eigen::Vector4d y(p_world.x(), p_world.y(), p_world.z(), -1.0);
    return y.dot(sum.selfadjointView<Eigen::Lower>() * y);
  }
};

/// The sum over all points of a body, 73 numbers: with x̃ = (p_body, 1), Σ w (n nᵀ) ⊗ (x̃ x̃ᵀ), Σ w d n x̃ᵀ and Σ w d².
/// Squares of distances from the world's origin are in it: with weights of 1e7 /m² and 100 planes χ² is good to 1e-5
/// where planes are within 10 m of the origin; move the origin for a world that is larger.
class PlaneSums {
 public:
  void add(const Eigen::Vector3d& p_body, const PlaneGram& gram);
  void remove(const Eigen::Vector3d& p_body, const PlaneGram& gram);
  void add(const PlaneConstraint& constraint);
  void remove(const PlaneConstraint& constraint);

  /// Σ w x̃ᵢ x̃ⱼ n nᵀ, i and j in 0..3.
  Eigen::Matrix3d normals(int i, int j) const;
  /// Σ w d x̃ᵢ n in column i.
  const Eigen::Matrix<double, 3, 4>& offsets() const { return offsets_; }
  /// Σ w d².
  double squares() const { return squares_; }

 private:
  void add(const Eigen::Vector3d& p_body, const PlaneGram& gram, double sign);

  // One column per pair (i, j) of x̃: 00, 10, 20, 30, 11, 21, 31, 22, 32, 33; in it n nᵀ as 00, 10, 20, 11, 21, 22.
  Eigen::Matrix<double, 6, 10> normals_ = Eigen::Matrix<double, 6, 10>::Zero();
  Eigen::Matrix<double, 3, 4> offsets_ = Eigen::Matrix<double, 3, 4>::Zero();
  double squares_ = 0.0;
};

/// Constraints of one point are summed first where they follow each other: keep them together, it is five times faster.
PlaneSums sum_planes(std::span<const PlaneConstraint> constraints);

/// Σ w (n · (T p) - d)², from the sums.
double chi2(const PlaneSums& sums, const Eigen::Isometry3d& T_world_body);

/// Information of the right perturbation (translation, rotation) of T_world_body: Σ w J Jᵀ, m and rad.
Matrix6d information(const PlaneSums& sums, const Eigen::Isometry3d& T_world_body);

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// χ² as a function of the rotation alone, E(a) = aᵀ G a - 2 gᵀ a + h with a = vec(R_world_body) by columns, the
/// translation being the best one for it, b = b0 - B a. Along directions of translation that no plane tells (normals in
/// one plane or parallel) b is 0. Source: marker1d paper page, "Elimination of b".
struct RotationCost {
  Matrix9d G = Matrix9d::Zero();
  Vector9d g = Vector9d::Zero();
  double h = 0.0;
  Eigen::Matrix<double, 3, 9> B = Eigen::Matrix<double, 3, 9>::Zero();
  Eigen::Vector3d b0 = Eigen::Vector3d::Zero();
  int translation_rank = 0;  ///< 3: the normals span space

  double operator()(const Eigen::Matrix3d& R_world_body) const;
  Eigen::Vector3d translation(const Eigen::Matrix3d& R_world_body) const;
};

RotationCost eliminate_translation(const PlaneSums& sums);

}  // namespace alidade
