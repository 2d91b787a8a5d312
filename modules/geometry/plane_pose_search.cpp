// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane_pose_search.h"

#include <algorithm>
#include <cmath>

#include "geometry/marker_places.h"
#include "geometry/rotation_spread.h"

namespace alidade {
namespace {

using Constraints = std::span<const PlaneConstraint>;

// What the planes that do not fit cost beside those that do.
double robust_chi2(const RobustPlanePose& pose, double gate_chi2) {
  return pose.pose.chi2 +
         gate_chi2 * static_cast<double>(pose.is_inlier.size() - static_cast<std::size_t>(pose.inlier_count));
}

// Two solutions are one where each lies within the other's uncertainty.
bool is_same(const RobustPlanePose& a, const RobustPlanePose& b) {
  const Vector6d apart = difference(a.pose.T_world_body, b.pose.T_world_body);
  return apart.dot(a.pose.information * apart) < 36.0 || apart.dot(b.pose.information * apart) < 36.0;
}

class PoseSearch {
 public:
  PoseSearch(Constraints constraints, const PlaneSearchOptions& options)
      : constraints_(constraints), options_(options) {}

  void solve_from(const Eigen::Isometry3d& start) {
    std::optional<RobustPlanePose> solution = solve_robustly(constraints_, start, options_.robust);
    if (!solution) return;
    for (RobustPlanePose& known : found_) {
      if (!is_same(known, *solution)) continue;
      if (chi2_of(*solution) < chi2_of(known)) known = std::move(*solution);
      return;
    }
    found_.push_back(std::move(*solution));
  }

  // One wrong plane among few right ones can hold a pose beside the right one: each inlier of the best is left out
  // once.
  void leave_each_out() {
    if (found_.empty()) return;
    const RobustPlanePose best_so_far = *std::min_element(
        found_.begin(), found_.end(), [&](const auto& a, const auto& b) { return chi2_of(a) < chi2_of(b); });
    if (best_so_far.inlier_count > kManyInliers * static_cast<double>(constraints_.size())) return;
    std::vector<PlaneConstraint> others(constraints_.begin() + 1, constraints_.end());
    for (std::size_t i = 0; i < constraints_.size(); ++i) {
      if (i > 0) others[i - 1] = constraints_[i - 1];
      if (!best_so_far.is_inlier[i]) continue;
      const auto without = solve_robustly(others, best_so_far.pose.T_world_body, options_.robust);
      if (without && !is_same(best_so_far, *without)) solve_from(without->pose.T_world_body);
    }
  }

  // All within the margin of the best, the best first.
  std::vector<RobustPlanePose> best() {
    std::sort(found_.begin(), found_.end(), [&](const auto& a, const auto& b) { return chi2_of(a) < chi2_of(b); });
    std::vector<RobustPlanePose> candidates;
    for (const RobustPlanePose& pose : found_) {
      const bool is_near = chi2_of(pose) <= chi2_of(found_.front()) + options_.margin_chi2;
      const bool is_new = std::none_of(candidates.begin(), candidates.end(),
                                       [&](const RobustPlanePose& known) { return is_same(known, pose); });
      if (is_near && is_new) candidates.push_back(pose);
    }
    return candidates;
  }

 private:
  static constexpr double kManyInliers = 0.75;  // a share of all that a wrong pose does not reach

  double chi2_of(const RobustPlanePose& pose) const { return robust_chi2(pose, options_.robust.gate_chi2); }

  Constraints constraints_;
  const PlaneSearchOptions& options_;
  std::vector<RobustPlanePose> found_;
};

// The verdict on a pose that no other one rivals, by its inliers alone.
PlaneVerdict judge_inliers(Constraints constraints, const RobustPlanePose& pose, const PlaneSearchOptions& options) {
  const double least =
      std::max<double>(options.least_inliers, options.least_share * static_cast<double>(constraints.size()));
  if (pose.inlier_count < least) return PlaneVerdict::Unexplained;
  std::vector<PlaneConstraint> inliers;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    if (pose.is_inlier[i]) inliers.push_back(constraints[i]);
  }
  return judge_minima(inliers, all_minima(inliers), options.judgement).verdict;
}

}  // namespace

PlaneSearch search_pose(Constraints constraints, const PlaneSearchOptions& options) {
  PlaneSearch result;
  require_planes(constraints);
  if (constraints.empty()) return result;
  PoseSearch search(constraints, options);
  const double gate = options.robust.gate_chi2;
  for (const Eigen::Isometry3d& T :
       poses_from_places(constraints, gate, options.most_points, options.most_hypotheses)) {
    search.solve_from(T);
  }
  const RotationCost cost = eliminate_translation(sum_planes(constraints));
  for (int i = 0; i < options.starts; ++i) {
    Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
    start.linear() = spread_rotation(i, options.starts);
    start.translation() = cost.translation(start.linear());
    search.solve_from(start);
  }
  search.leave_each_out();
  result.candidates = search.best();
  if (result.candidates.size() > 1) {
    result.verdict = PlaneVerdict::Ambiguous;
  } else if (result.candidates.size() == 1) {
    result.verdict = judge_inliers(constraints, result.candidates.front(), options);
  }
  return result;
}

}  // namespace alidade
