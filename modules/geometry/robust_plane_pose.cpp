// SPDX-License-Identifier: Apache-2.0
#include "geometry/robust_plane_pose.h"

#include <algorithm>
#include <cmath>

namespace alidade {
namespace {

using Constraints = std::span<const PlaneConstraint>;
using Lanes = Eigen::Array2d;  // two planes in one register

// What a loss makes of residuals: their weight in the least squares, and what its curvature would have it be.
struct Share {
  Lanes weight;
  Lanes curvature;
};

// ρ(s) = c² s / (c² + s): ρ' = u² and ρ' + 2 s ρ'' = u² (4 u - 3) with u = c² / (c² + s). The curvature is kept above a
// share of the weight: all of it (mere reweighting) is safe from afar, a small one leaves Newton's steps nearby.
struct GemanMcClure {
  double c2;
  double least_curvature;
  Share operator()(const Lanes& chi2) const {
    const Lanes u = c2 / (c2 + chi2);
    const Lanes weight = u * u;
    return {weight, weight * (4.0 * u - 3.0).max(least_curvature)};
  }
};

// All or nothing.
struct Gate {
  double c2;
  Share operator()(const Lanes& chi2) const {
    const Lanes fits(chi2(0) <= c2 ? 1.0 : 0.0, chi2(1) <= c2 ? 1.0 : 0.0);
    return {fits, fits};
  }
};

// Two planes of one point; the second one of an odd number has no weight.
struct PairOfPlanes {
  Lanes x = Lanes::Zero(), y = Lanes::Zero(), z = Lanes::Zero(), offset = Lanes::Zero(), weight = Lanes::Zero();

  void set(int lane, const PlaneConstraint& constraint) {
    x(lane) = constraint.plane_world.normal.x();
    y(lane) = constraint.plane_world.normal.y();
    z(lane) = constraint.plane_world.normal.z();
    offset(lane) = constraint.plane_world.offset;
    weight(lane) = constraint.weight;
  }

  Lanes distance(const Eigen::Vector3d& p) const { return x * p.x() + y * p.y() + z * p.z() - offset; }
};

// Σ n nᵀ, Σ n residual and shares over the planes of one point, weighed.
struct PointSum {
  Lanes xx = Lanes::Zero(), yx = Lanes::Zero(), zx = Lanes::Zero(), yy = Lanes::Zero(), zy = Lanes::Zero();
  Lanes zz = Lanes::Zero(), rx = Lanes::Zero(), ry = Lanes::Zero(), rz = Lanes::Zero();
  Lanes share = Lanes::Zero();

  template <class Loss>
  void add(const PairOfPlanes& planes, const Eigen::Vector3d& p_world, Loss loss) {
    const Lanes r = planes.distance(p_world);
    const Share s = loss(planes.weight * r * r);
    const Lanes curvature = s.curvature * planes.weight, pull = s.weight * planes.weight * r;
    const Lanes x = curvature * planes.x, y = curvature * planes.y, z = curvature * planes.z;
    xx += x * planes.x;
    yx += y * planes.x;
    zx += z * planes.x;
    yy += y * planes.y;
    zy += z * planes.y;
    zz += z * planes.z;
    rx += pull * planes.x;
    ry += pull * planes.y;
    rz += pull * planes.z;
    share += s.weight;
  }
};

// Gauss–Newton's system for a pose moved along the world's axes: T(p) + t + φ × R p.
struct WorldEquations {
  Eigen::Matrix3d translation = Eigen::Matrix3d::Zero();  // Σ n nᵀ
  Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero();        // Σ [arm]× n nᵀ
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();     // Σ [arm]× n nᵀ [arm]×ᵀ
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();         // Σ n residual
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();       // Σ arm × n residual
  double share = 0.0;                                     // how many constraints take part

  // The planes of a point at `arm` from the body's origin, along the world's axes.
  void add(const PointSum& sum, const Eigen::Vector3d& arm) {
    const double yx = sum.yx.sum(), zx = sum.zx.sum(), zy = sum.zy.sum();
    Eigen::Matrix3d N;
    N << sum.xx.sum(), yx, zx, yx, sum.yy.sum(), zy, zx, zy, sum.zz.sum();
    const Eigen::Vector3d point_pull(sum.rx.sum(), sum.ry.sum(), sum.rz.sum());
    Eigen::Matrix3d arm_N;  // [arm]× N, row by row
    arm_N.row(0) = arm.y() * N.row(2) - arm.z() * N.row(1);
    arm_N.row(1) = arm.z() * N.row(0) - arm.x() * N.row(2);
    arm_N.row(2) = arm.x() * N.row(1) - arm.y() * N.row(0);
    translation += N;
    mixed += arm_N;
    rotation.col(0) += arm.y() * arm_N.col(2) - arm.z() * arm_N.col(1);
    rotation.col(1) += arm.z() * arm_N.col(0) - arm.x() * arm_N.col(2);
    rotation.col(2) += arm.x() * arm_N.col(1) - arm.y() * arm_N.col(0);
    pull += point_pull;
    moment += arm.cross(point_pull);
    share += sum.share.sum();
  }
};

// Of the right perturbation at T.
Matrix6d information_of(const WorldEquations& sum, const Eigen::Isometry3d& T) {
  const Eigen::Matrix3d R = T.linear();
  Matrix6d information;
  information.topLeftCorner<3, 3>() = R.transpose() * sum.translation * R;
  information.bottomLeftCorner<3, 3>() = R.transpose() * sum.mixed * R;
  information.bottomRightCorner<3, 3>() = R.transpose() * sum.rotation * R;
  information.topRightCorner<3, 3>() = information.bottomLeftCorner<3, 3>().transpose();
  return information;
}

struct Step {
  Eigen::Vector3d translation;
  Eigen::Vector3d rotation;
  double sigmas;  // its length in standard deviations
};

// H⁻¹ of a symmetric H; empty where H is not positive definite to well above rounding.
std::optional<Eigen::Matrix3d> invert_positive(const Eigen::Matrix3d& H) {
  Eigen::Matrix3d inverse;
  inverse.col(0) = H.col(1).cross(H.col(2));
  inverse.col(1) = H.col(2).cross(H.col(0));
  inverse.col(2) = H.col(0).cross(H.col(1));
  const double determinant = inverse.col(0).dot(H.col(0));
  const double mean = H.trace() / 3.0;
  if (!(determinant > 1e-13 * mean * mean * mean)) return std::nullopt;
  return inverse * (1.0 / determinant);
}

// Empty where the system is singular. The translation is eliminated, then the rotation's three unknowns are left.
std::optional<Step> step_of(const WorldEquations& sum) {
  const std::optional<Eigen::Matrix3d> M = invert_positive(sum.translation);
  if (!M) return std::nullopt;
  const Eigen::Matrix3d K = sum.mixed * *M;
  const std::optional<Eigen::Matrix3d> H = invert_positive(sum.rotation - K * sum.mixed.transpose());
  if (!H) return std::nullopt;
  Step step;
  step.rotation = *H * (K * sum.pull - sum.moment);
  step.translation = -(*M * (sum.pull + sum.mixed.transpose() * step.rotation));
  const double decrease = -step.rotation.dot(sum.moment) - step.translation.dot(sum.pull);
  step.sigmas = std::sqrt(std::max(0.0, decrease));
  return step;
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& T, const Step& step) {
  const Eigen::Vector3d h = 0.5 * step.rotation;
  Eigen::Isometry3d result = T;
  result.linear() = Eigen::Quaterniond(1.0, h.x(), h.y(), h.z()).normalized().toRotationMatrix() * T.linear();
  result.translation() += step.translation;
  return result;
}

// Constraints in pairs, by point.
class PairedPlanes {
 public:
  explicit PairedPlanes(Constraints constraints) {
    pairs_.reserve(constraints.size());
    points_.reserve(constraints.size());
    for (std::size_t i = 0; i < constraints.size();) {
      const Eigen::Vector3d& p_body = constraints[i].p_body;
      for (int lane = 0; i < constraints.size() && constraints[i].p_body == p_body; ++i, lane ^= 1) {
        if (lane == 0) pairs_.emplace_back();
        pairs_.back().set(lane, constraints[i]);
      }
      points_.push_back({p_body, pairs_.size()});
    }
  }

  template <class Loss>
  WorldEquations equations_at(const Eigen::Isometry3d& T, Loss loss) const {
    WorldEquations equations;
    std::size_t i = 0;
    for (const Point& point : points_) {
      const Eigen::Vector3d arm = T.linear() * point.p_body;
      const Eigen::Vector3d p_world = arm + T.translation();
      PointSum sum;
      for (; i < point.end; ++i) sum.add(pairs_[i], p_world, loss);
      equations.add(sum, arm);
    }
    return equations;
  }

  // weight · distance² of each constraint, and zeros for what fills up pairs.
  std::vector<Lanes> chi2_at(const Eigen::Isometry3d& T) const {
    std::vector<Lanes> chi2;
    chi2.reserve(pairs_.size());
    for (const Point& point : points_) {
      const Eigen::Vector3d p_world = T * point.p_body;
      while (chi2.size() < point.end) {
        const PairOfPlanes& pair = pairs_[chi2.size()];
        chi2.push_back(pair.weight * pair.distance(p_world).square());
      }
    }
    return chi2;
  }

  Eigen::Isometry3d descend(Eigen::Isometry3d T, double width, int steps, double last_step) const {
    constexpr double kNear = 2.0;  // standard deviations
    double least_curvature = 1.0;
    for (int i = 0; i < steps; ++i) {
      const std::optional<Step> step = step_of(equations_at(T, GemanMcClure{width, least_curvature}));
      if (!step) break;
      T = moved(T, *step);
      // Newton's step leaves little undone, reweighting a seventh.
      if (step->sigmas < (least_curvature < 1.0 ? last_step : 0.2 * last_step)) break;
      least_curvature = step->sigmas < kNear ? 0.2 : 1.0;
    }
    return T;
  }

 private:
  struct Point {
    Eigen::Vector3d p_body;
    std::size_t end;  // one behind its last pair
  };

  std::vector<PairOfPlanes> pairs_;
  std::vector<Point> points_;
};

// So wide that half of the constraints keep four fifths of their weight: the first step then ends near the pose.
double first_mu(const PairedPlanes& planes, const Eigen::Isometry3d& T, const RobustPlaneOptions& options) {
  constexpr double kAmple = 8.0;
  std::vector<Lanes> chi2 = planes.chi2_at(T);
  const std::span<double> each(chi2.front().data(), 2 * chi2.size());
  const auto half = each.begin() + static_cast<std::ptrdiff_t>(each.size() / 2);
  std::nth_element(each.begin(), half, each.end());
  return std::min(options.widest_mu, kAmple * *half / options.gate_chi2);
}

Eigen::Isometry3d graduate(const PairedPlanes& planes, Eigen::Isometry3d T, const RobustPlaneOptions& options,
                           double last_step) {
  constexpr double kNarrowing = 0.2;
  for (double mu = first_mu(planes, T, options); mu > 1.0; mu *= kNarrowing) {
    T = planes.descend(T, mu * options.gate_chi2, options.steps_per_stage, last_step);
  }
  return planes.descend(T, options.gate_chi2, options.max_iterations, last_step);
}

struct Settled {
  Eigen::Isometry3d T_world_body;
  WorldEquations equations;
};

// Least squares on what fits at the pose so far; each step decides anew what does. Empty where too few fit.
std::optional<Settled> settle(const PairedPlanes& planes, Eigen::Isometry3d T, const RobustPlaneOptions& options) {
  constexpr double kFine = 1e-3;  // standard deviations: what a step leaves undone is its square
  for (int round = 1;; ++round) {
    const WorldEquations equations = planes.equations_at(T, Gate{options.gate_chi2});
    const std::optional<Step> step = step_of(equations);
    if (equations.share < options.least_inliers || !step) return std::nullopt;
    T = moved(T, *step);
    if (step->sigmas < kFine || round >= options.max_iterations) return Settled{T, equations};
  }
}

}  // namespace

Eigen::Isometry3d descend_robustly(Constraints constraints, const Eigen::Isometry3d& start,
                                   const RobustPlaneOptions& options, double last_step) {
  if (constraints.empty()) return start;
  return graduate(PairedPlanes(constraints), start, options, last_step);
}

std::optional<RobustPlanePose> solve_robustly(Constraints constraints, const Eigen::Isometry3d& start,
                                              const RobustPlaneOptions& options) {
  if (constraints.empty()) return std::nullopt;
  constexpr double kRough = 0.3;  // standard deviations: what is left to settle()
  const PairedPlanes planes(constraints);
  const auto settled = settle(planes, graduate(planes, start, options, kRough), options);
  if (!settled) return std::nullopt;
  const Eigen::Isometry3d& T = settled->T_world_body;
  RobustPlanePose result{{T, 0.0, information_of(settled->equations, T)}, {}, 0};
  if (determined_directions(result.pose.information) < 6) return std::nullopt;
  result.is_inlier.reserve(constraints.size());
  for (const PlaneConstraint& constraint : constraints) {
    const double r = distance(constraint.plane_world, T * constraint.p_body);
    const double chi2 = constraint.weight * r * r;
    const bool fits = chi2 <= options.gate_chi2;
    result.is_inlier.push_back(fits);
    if (!fits) continue;
    result.pose.chi2 += chi2;
    ++result.inlier_count;
  }
  return result;
}

}  // namespace alidade
