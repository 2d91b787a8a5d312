// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane_valley.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace alidade {
namespace {

constexpr double kFirstStep = 2e-3;  // along the floor, m and rad
constexpr double kFarthest = 0.5;
constexpr double kUnlikely = 12.0;  // χ² above the minimum's, where the floor is left
constexpr double kHold = 1e12;      // information that keeps a place along the floor, far above what planes tell

struct Linearised {
  double chi2 = 0.0;
  Vector6d gradient = Vector6d::Zero();
  Matrix6d information = Matrix6d::Zero();
};

Linearised linearise(std::span<const PlaneConstraint> constraints, const Eigen::Isometry3d& T) {
  Linearised sum;
  for (const PlaneConstraint& c : constraints) {
    const Eigen::Vector3d n_body = T.linear().transpose() * c.plane_world.normal;
    Vector6d row;
    row << n_body, c.p_body.cross(n_body);
    const double r = distance(c.plane_world, T * c.p_body);
    sum.chi2 += c.weight * r * r;
    sum.gradient += (c.weight * r) * row;
    sum.information += (c.weight * row) * row.transpose();
  }
  return sum;
}

// The lowest place across `along` near a pose.
Eigen::Isometry3d descend_across(std::span<const PlaneConstraint> constraints, Eigen::Isometry3d T,
                                 const Vector6d& along) {
  for (int step = 0; step < 3; ++step) {
    Linearised at = linearise(constraints, T);
    at.information += kHold * along * along.transpose();
    T = T * perturbation(-at.information.llt().solve(at.gradient));
  }
  return T;
}

struct FloorPoint {
  Vector6d xi;  // from the minimum
  double chi2;
};

// Steps from the minimum one way until χ² has risen; empty where it does not.
std::vector<FloorPoint> walk(std::span<const PlaneConstraint> constraints, const PlanePose& minimum,
                             const Vector6d& along) {
  std::vector<FloorPoint> floor;
  Eigen::Isometry3d T = minimum.T_world_body;
  for (double step = kFirstStep, gone = 0; gone < kFarthest;) {
    const Eigen::Isometry3d next = descend_across(constraints, T * perturbation(step * along), along);
    const double chi2 = linearise(constraints, next).chi2 - minimum.chi2;
    if (chi2 > kUnlikely && step < 1e-2 * kFirstStep) return floor;
    if (chi2 > kUnlikely) {
      step /= 2;
      continue;
    }
    if (chi2 > kUnlikely / 2) {
      floor.push_back({difference(minimum.T_world_body, next), chi2});
      return floor;
    }
    floor.push_back({difference(minimum.T_world_body, next), chi2});
    T = next;
    gone += step;
  }
  return {};
}

}  // namespace

std::optional<PlaneValley> follow_valley(std::span<const PlaneConstraint> constraints, const PlanePose& minimum) {
  if (determined_directions(minimum.information) != 5) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(minimum.information);
  const Vector6d along = solver.eigenvectors().col(0);
  std::vector<FloorPoint> floor{{Vector6d::Zero(), 0.0}};
  for (const Vector6d& way : {along, Vector6d(-along)}) {
    const std::vector<FloorPoint> part = walk(constraints, minimum, way);
    if (part.empty()) return std::nullopt;
    floor.insert(floor.end(), part.begin(), part.end());
  }
  double sum = 0;
  Vector6d mean = Vector6d::Zero();
  for (const FloorPoint& point : floor) {
    const double likelihood = std::exp(-point.chi2 / 2);
    sum += likelihood;
    mean += likelihood * point.xi;
  }
  mean /= sum;
  PlaneValley valley{minimum.T_world_body * perturbation(mean), Matrix6d::Zero()};
  for (const FloorPoint& point : floor) {
    valley.covariance += std::exp(-point.chi2 / 2) / sum * (point.xi - mean) * (point.xi - mean).transpose();
  }
  const Eigen::Matrix<double, 6, 5> across = solver.eigenvectors().rightCols<5>();
  valley.covariance += across * solver.eigenvalues().tail<5>().cwiseInverse().asDiagonal() * across.transpose();
  return valley;
}

}  // namespace alidade
