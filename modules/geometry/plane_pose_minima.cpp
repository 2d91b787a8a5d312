// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane_pose_minima.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "geometry/rotation.h"
#include "geometry/rotation_descent.h"
#include "geometry/rotation_spread.h"

namespace alidade {
namespace {

using Constraints = std::span<const PlaneConstraint>;

// Minima of a rotation cost, found from here and there.
class MinimaSearch {
 public:
  MinimaSearch(const RotationCost& cost, double same_rad) : cost_(cost), same_(2.0 - 2.0 * std::cos(same_rad)) {}

  void descend_from(const Eigen::Matrix3d& R) {
    RotationMinimum minimum = descend(cost_, R);
    if (!minimum.is_minimum && unfinished_++ < kMostPatient) {
      minimum = descend(cost_, minimum.R_world_body, {kPatience, 1e-7});
    }
    if (!minimum.is_minimum && !(minimum.cost < lowest_unfinished_.cost)) return;
    if (minimum.is_minimum) {
      if (!is_known(minimum.R_world_body)) found_.push_back(minimum);
    } else {
      lowest_unfinished_ = minimum;
    }
  }

  // A valley floor without a minimum that was reached: its lowest point so far, unless a minimum is as low.
  void keep_lowest_unfinished() {
    const auto is_lower = [&](const RotationMinimum& known) { return known.cost <= lowest_unfinished_.cost; };
    if (std::isfinite(lowest_unfinished_.cost) && std::none_of(found_.begin(), found_.end(), is_lower)) {
      found_.push_back(lowest_unfinished_);
    }
  }

  // Two minima that are about to merge share a valley, and one of them has so small a basin that starts miss it: from
  // each minimum along its softest direction, both ways.
  void look_along_valleys() {
    for (std::size_t i = 0; i < found_.size() && i < kMost; ++i) {
      const Eigen::Matrix3d R = found_[i].R_world_body;
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(found_[i].hessian);
      for (const double angle : {0.1, -0.1, 0.4, -0.4}) {
        descend_from(R * exp_so3(angle * solver.eigenvectors().col(0)));
      }
    }
  }

  const std::vector<RotationMinimum>& found() const { return found_; }

 private:
  static constexpr std::size_t kMost = 24;
  static constexpr int kPatience = 400, kMostPatient = 4;  // steps, and how often so many are spent

  bool is_known(const Eigen::Matrix3d& R) const {
    return std::any_of(found_.begin(), found_.end(), [&](const RotationMinimum& known) {
      return (known.R_world_body - R).squaredNorm() < 2.0 * same_;  // 4 (1 - cos angle)
    });
  }

  const RotationCost& cost_;
  double same_;
  std::vector<RotationMinimum> found_;
  int unfinished_ = 0;
  RotationMinimum lowest_unfinished_{.cost = std::numeric_limits<double>::infinity()};
};

// Whether χ² is more than `sigmas` beyond its expectation. Source: Wilson, Hilferty 1931.
bool is_too_large(double chi2, int degrees_of_freedom, double sigmas) {
  if (degrees_of_freedom <= 0) return false;
  const double variance = 2.0 / (9.0 * degrees_of_freedom);
  return std::cbrt(chi2 / degrees_of_freedom) > 1.0 - variance + sigmas * std::sqrt(variance);
}

// E where the valley passes `angle` beside R along `axis`: the lowest value across the axis.
double valley_cost(const RotationCost& cost, const Eigen::Matrix3d& R, const Eigen::Vector3d& axis, double angle) {
  Eigen::Matrix<double, 3, 2> across;
  across << axis.unitOrthogonal(), axis.cross(axis.unitOrthogonal());
  Eigen::Matrix3d there = R * exp_so3(angle * axis);
  for (int i = 0; i < 2; ++i) {
    const RotationSlope at = slope(cost, there);
    const Eigen::Matrix2d H = across.transpose() * at.gauss_newton * across;
    there = there * exp_so3(-across * H.ldlt().solve(across.transpose() * at.gradient));
  }
  return cost(there);
}

// Whether the minimum rises, as far as the margin reaches, as its information promises.
bool is_sharp(const RotationCost& cost, const Eigen::Matrix3d& R, const PlaneJudgementOptions& options) {
  const RotationSlope at = slope(cost, R);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(at.gauss_newton);
  const double softest = solver.eigenvalues()(0);
  if (!(softest * options.bluntest_rad * options.bluntest_rad > 1.0)) return false;
  const Eigen::Vector3d axis = solver.eigenvectors().col(0);
  const double reach = std::sqrt(options.margin_chi2 / softest);
  const double least = 2.0 * at.half_cost + options.least_rise * options.margin_chi2;
  return valley_cost(cost, R, axis, reach) > least && valley_cost(cost, R, axis, -reach) > least;
}

}  // namespace

std::vector<PlanePose> all_minima(Constraints constraints, const PlaneMinimaOptions& options) {
  require_planes(constraints);
  if (constraints.empty()) return {};
  const RotationCost cost = eliminate_translation(sum_planes(constraints));
  MinimaSearch search(cost, options.same_rotation_rad);
  for (int i = 0; i < options.starts; ++i) search.descend_from(spread_rotation(i, options.starts));
  search.look_along_valleys();
  search.keep_lowest_unfinished();
  std::vector<PlanePose> minima;
  for (const RotationMinimum& minimum : search.found()) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = minimum.R_world_body;
    T.translation() = cost.translation(T.linear());
    minima.push_back(plane_pose_at(constraints, T));
  }
  std::sort(minima.begin(), minima.end(), [](const PlanePose& a, const PlanePose& b) { return a.chi2 < b.chi2; });
  return minima;
}

PlaneJudgement judge_minima(Constraints constraints, std::span<const PlanePose> minima,
                            const PlaneJudgementOptions& options) {
  PlaneJudgement judgement;
  judgement.candidates.assign(minima.begin(), minima.end());
  const auto by_chi2 = [](const PlanePose& a, const PlanePose& b) { return a.chi2 < b.chi2; };
  std::sort(judgement.candidates.begin(), judgement.candidates.end(), by_chi2);
  if (judgement.candidates.empty()) return judgement;
  const double best = judgement.candidates.front().chi2;
  std::erase_if(judgement.candidates, [&](const PlanePose& m) { return m.chi2 > best + options.margin_chi2; });

  const auto is_open = [](const PlanePose& m) { return determined_directions(m.information) < 6; };
  const RotationCost cost = eliminate_translation(sum_planes(constraints));
  if (is_too_large(best, static_cast<int>(constraints.size()) - 6, options.most_sigmas)) {
    judgement.verdict = PlaneVerdict::Unexplained;
  } else if (constraints.size() < 6 || std::any_of(judgement.candidates.begin(), judgement.candidates.end(), is_open)) {
    judgement.verdict = PlaneVerdict::Undetermined;
  } else if (judgement.candidates.size() > 1 ||
             !is_sharp(cost, judgement.candidates.front().T_world_body.linear(), options)) {
    judgement.verdict = PlaneVerdict::Ambiguous;
  } else {
    judgement.verdict = PlaneVerdict::Certain;
  }
  return judgement;
}

}  // namespace alidade
