// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane_pose.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "geometry/rotation.h"
#include "geometry/rotation_descent.h"

namespace alidade {
namespace {

using Constraints = std::span<const PlaneConstraint>;

// Gauss–Newton's system for a pose moved along the world's axes: T(p) + t + φ × R p.
struct WorldEquations {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double weight = 0.0;  // the share of the constraints that take part

  // What `gram` says of a point at T(p), p turned into the world being `arm`.
  void add(const PlaneGram& gram, const Eigen::Vector3d& arm, const Eigen::Vector3d& p_world) {
    Eigen::Matrix3d N = gram.sum.topLeftCorner<3, 3>();
    N(0, 1) = N(1, 0);
    N(0, 2) = N(2, 0);
    N(1, 2) = N(2, 1);
    const Eigen::Vector3d pull = N * p_world - gram.sum.row(3).head<3>().transpose();
    Eigen::Matrix3d arm_N;  // [arm]× N, column by column
    for (int i = 0; i < 3; ++i) arm_N.col(i) = arm.cross(N.col(i));
    information.topLeftCorner<3, 3>() += N;
    information.bottomLeftCorner<3, 3>() += arm_N;
    for (int i = 0; i < 3; ++i) information.block<1, 3>(3 + i, 3) += arm.cross(arm_N.row(i)).transpose();
    gradient.head<3>() += pull;
    gradient.tail<3>() += arm.cross(pull);
  }
};

Eigen::Isometry3d moved(const Eigen::Isometry3d& T, const Vector6d& step) {
  Eigen::Isometry3d result = T;
  result.linear() = exp_so3(step.tail<3>()) * T.linear();
  result.translation() += step.head<3>();
  return result;
}

double chi2_of(const PlaneConstraint& constraint, const Eigen::Vector3d& p_world) {
  const double r = distance(constraint.plane_world, p_world);
  return constraint.weight * r * r;
}

std::vector<double> chi2_of_each(Constraints constraints, const Eigen::Isometry3d& T) {
  std::vector<double> chi2(constraints.size());
  for (std::size_t i = 0; i < chi2.size(); ++i) chi2[i] = chi2_of(constraints[i], T * constraints[i].p_body);
  return chi2;
}

// Constraints weighed by weight_of(χ²), points that follow each other taken together.
template <class WeightOf>
WorldEquations equations_at(Constraints constraints, const Eigen::Isometry3d& T, WeightOf weight_of) {
  WorldEquations sum;
  for (std::size_t i = 0; i < constraints.size();) {
    const Eigen::Vector3d p_body = constraints[i].p_body;
    const Eigen::Vector3d arm = T.linear() * p_body;
    const Eigen::Vector3d p_world = arm + T.translation();
    PlaneGram gram;
    for (; i < constraints.size() && constraints[i].p_body == p_body; ++i) {
      const double share = weight_of(chi2_of(constraints[i], p_world));
      gram.add(constraints[i].plane_world, share * constraints[i].weight);
      sum.weight += share;
    }
    sum.add(gram, arm, p_world);
  }
  return sum;
}

struct Step {
  Vector6d xi;
  double sigmas;  // its length in standard deviations
};

// Empty where the system is singular.
std::optional<Step> step_of(const WorldEquations& equations) {
  const Eigen::LLT<Matrix6d> factor(equations.information);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Vector6d xi = -factor.solve(equations.gradient);
  if (!xi.allFinite()) return std::nullopt;
  return Step{xi, std::sqrt(std::max(0.0, -xi.dot(equations.gradient)))};
}

Eigen::Isometry3d descend(Constraints constraints, Eigen::Isometry3d T, double width, int steps, double last_step) {
  const double per_width = 1.0 / width;
  const auto weight_of = [per_width](double chi2) {
    const double root = 1.0 / (1.0 + per_width * chi2);
    return root * root;
  };
  for (int i = 0; i < steps; ++i) {
    const std::optional<Step> step = step_of(equations_at(constraints, T, weight_of));
    if (!step) break;
    T = moved(T, step->xi);
    if (step->sigmas < last_step) break;
  }
  return T;
}

// Where a third of the constraints lie within the gate times mu.
double first_mu(Constraints constraints, const Eigen::Isometry3d& T, const RobustPlaneOptions& options) {
  std::vector<double> chi2 = chi2_of_each(constraints, T);
  const auto third = chi2.begin() + static_cast<std::ptrdiff_t>(chi2.size() / 3);
  std::nth_element(chi2.begin(), third, chi2.end());
  return std::min(options.widest_mu, *third / options.gate_chi2);
}

// Least squares on what fits at the pose so far; each round decides anew what does.
std::optional<RobustPlanePose> settle(Constraints constraints, Eigen::Isometry3d T, const RobustPlaneOptions& options) {
  const auto within_gate = [&](double chi2) { return chi2 <= options.gate_chi2 ? 1.0 : 0.0; };
  for (int round = 0; round < options.max_iterations; ++round) {
    const WorldEquations equations = equations_at(constraints, T, within_gate);
    const std::optional<Step> step = step_of(equations);
    if (equations.weight < options.least_inliers || !step) return std::nullopt;
    T = moved(T, step->xi);
    if (step->sigmas < options.last_step) break;
  }
  RobustPlanePose result;
  std::vector<PlaneConstraint> inliers;
  for (const double chi2 : chi2_of_each(constraints, T)) {
    const bool fits = chi2 <= options.gate_chi2;
    if (fits) inliers.push_back(constraints[result.is_inlier.size()]);
    result.is_inlier.push_back(fits);
  }
  result.inlier_count = static_cast<int>(inliers.size());
  result.pose = plane_pose_at(inliers, T);
  if (result.inlier_count < options.least_inliers || determined_directions(result.pose.information) < 6) {
    return std::nullopt;
  }
  return result;
}

}  // namespace

int determined_directions(const Matrix6d& information, double least_share) {
  Vector6d scale = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    if (information(i, i) > 0) scale(i) = 1.0 / std::sqrt(information(i, i));
  }
  const Matrix6d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled, Eigen::EigenvaluesOnly);
  return static_cast<int>((solver.eigenvalues().array() > least_share).count());
}

PlanePose plane_pose_at(Constraints constraints, const Eigen::Isometry3d& T_world_body) {
  PlanePose result{T_world_body, 0.0, information(sum_planes(constraints), T_world_body)};
  for (const double chi2 : chi2_of_each(constraints, T_world_body)) result.chi2 += chi2;
  return result;
}

std::optional<Eigen::Isometry3d> newton_pose(const PlaneSums& sums, const Eigen::Isometry3d& start) {
  const RotationCost cost = eliminate_translation(sums);
  if (cost.translation_rank < 3) return std::nullopt;
  const std::optional<Eigen::Matrix3d> R = newton_rotation(cost, start.linear());
  if (!R) return std::nullopt;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = *R;
  T.translation() = cost.translation(*R);
  return T;
}

Eigen::Isometry3d descend_robustly(Constraints constraints, const Eigen::Isometry3d& start,
                                   const RobustPlaneOptions& options) {
  return descend(constraints, start, options.gate_chi2, options.max_iterations, options.last_step);
}

std::optional<RobustPlanePose> solve_robustly(Constraints constraints, const Eigen::Isometry3d& start,
                                              const RobustPlaneOptions& options) {
  if (constraints.size() < static_cast<std::size_t>(options.least_inliers)) return std::nullopt;
  constexpr double kNarrowing = 0.25;
  constexpr double kRough = 0.1;  // standard deviations: what a stage leaves to the next
  Eigen::Isometry3d T = start;
  for (double mu = first_mu(constraints, T, options); mu > 1.0; mu *= kNarrowing) {
    T = descend(constraints, T, mu * options.gate_chi2, options.steps_per_stage, kRough);
  }
  return settle(constraints, descend(constraints, T, options.gate_chi2, options.max_iterations, kRough), options);
}

}  // namespace alidade
