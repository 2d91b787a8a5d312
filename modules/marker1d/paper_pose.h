// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/rigid_body.h"
#include "marker1d/marker_plane.h"

namespace alidade {

/// Sums over planes, one 4×4 Σ w (n, -d)(n, -d)ᵀ per marker of the body: all that the planes say of it. Offsets count
/// from `origin_world`: near the body, the sums' digits go into the pose. A plane is taken back as it was added.
/// Source: marker1d paper page, "The Gram trick".
class PaperSums {
 public:
  PaperSums(const RigidBody& body, const Eigen::Vector3d& origin_world)
      : body_(body), origin_world_(origin_world), grams_(body.markers.size(), Eigen::Matrix4d::Zero()) {}

  void add(const MarkerPlane& plane, double weight);
  void remove(const MarkerPlane& plane, double weight) { add(plane, -weight); }

  const RigidBody& body() const { return body_; }
  const Eigen::Vector3d& origin_world() const { return origin_world_; }
  const Eigen::Matrix4d& gram(std::size_t marker) const { return grams_[marker]; }

 private:
  const RigidBody& body_;
  Eigen::Vector3d origin_world_;
  std::vector<Eigen::Matrix4d> grams_;
};

/// The sum of weighted squared distances with the best translation for each rotation: E = aᵀ G a - 2 gᵀ a + h, where
/// a = vec(A) by columns, and the body's origin is at b = b0 - B a.
/// Source: marker1d paper page, "Elimination of b".
struct PaperCost {
  Eigen::Matrix<double, 9, 9> G;
  Eigen::Matrix<double, 9, 1> g;
  double h = 0.0;
  Eigen::Matrix<double, 3, 9> B;
  Eigen::Vector3d b0;   ///< m, world
  double spread = 0.0;  ///< least over greatest eigenvalue of Σ w n nᵀ: 0 where the normals do not span space

  double operator()(const Eigen::Matrix3d& A) const;
  Eigen::Vector3d translation(const Eigen::Matrix3d& A) const;
};

/// Empty where the normals do not span space, to rounding.
std::optional<PaperCost> eliminate_translation(const PaperSums& sums);

/// f_j = ½ ∂E/∂P_j and J_jk = ∂f_j/∂P_k at A(P) A_ref, exact.
struct PaperEquations {
  Eigen::Vector3d f;
  Eigen::Matrix3d J;
};
PaperEquations paper_equations(const PaperCost& cost, const Eigen::Vector3d& P, const Eigen::Matrix3d& A_ref);

struct PaperPoseOptions {
  int max_steps = 20;       ///< two or three from an extrapolated pose
  double last_step = 1e-7;  ///< |change of P| of the last step; the error left is its square
};

struct PaperPose {
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  int steps = 0;
  bool is_minimum = false;  ///< J is positive definite: E has neither a saddle nor a maximum there
};

/// Newton's method on f(P) = 0 from a start. Where a step reaches |P|² > 0.6 it ends there, and the attitude found
/// becomes the reference. Empty where J is singular or max_steps do not suffice.
std::optional<PaperPose> solve_paper_pose(const PaperCost& cost, const Eigen::Matrix3d& R_world_body_start,
                                          const PaperPoseOptions& options = {});

/// The same without a start: the lowest minimum that Newton reaches from the 24 rotations of a cube. The paper is
/// silent on its start.
std::optional<PaperPose> start_paper_pose(const PaperCost& cost, const PaperPoseOptions& options = {});

}  // namespace alidade
