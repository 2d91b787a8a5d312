// SPDX-License-Identifier: Apache-2.0
#include "evaluation/track_identity.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "estimation/assignment.h"

namespace alidade {
namespace {

using Eigen::Index;

// One target through the moments.
struct Course {
  TargetHistory history;
  Timestamp first{}, last{};
  std::optional<int> estimate;  // the last one's id
};

class Tally {
 public:
  void add(const TargetMoment& moment, double radius_m) {
    const auto estimate_of = pair_by_place(moment, radius_m);
    std::set<std::size_t> is_paired;
    for (std::size_t i = 0; i < moment.truth.size(); ++i) {
      Course& course = course_of(moment.truth[i].id, moment.time);
      course.last = moment.time;
      ++course.history.moments;
      if (!estimate_of[i]) continue;
      is_paired.insert(*estimate_of[i]);
      pair(course, moment.estimates[*estimate_of[i]].id, moment.time);
    }
    for (std::size_t j = 0; j < moment.estimates.size(); ++j) {
      const int id = moment.estimates[j].id;
      targets_of_[id];
      if (!is_paired.contains(j)) alone_at_[id] = moment.time;
    }
    end_ = moment.time;
  }

  TrackIdentity result() const {
    TrackIdentity identity;
    int moments = 0, paired = 0, pure = 0;
    for (const Course& course : courses_) {
      identity.targets.push_back(course.history);
      identity.targets.back().outlived_s = outlived(course);
      identity.switches += course.history.switches;
      moments += course.history.moments;
      paired += course.history.paired;
    }
    for (const auto& [id, counts] : targets_of_) {
      int most = 0;
      for (const auto& [target, count] : counts) most = std::max(most, count);
      pure += most;
      identity.false_ids += counts.empty();
    }
    if (paired > 0) identity.purity = static_cast<double>(pure) / paired;
    if (moments > 0) identity.completeness = static_cast<double>(paired) / moments;
    return identity;
  }

 private:
  Course& course_of(int target, Timestamp time) {
    const auto known =
        std::find_if(courses_.begin(), courses_.end(), [&](const Course& c) { return c.history.id == target; });
    if (known != courses_.end()) return *known;
    Course course;
    course.history.id = target;
    course.first = time;
    courses_.push_back(course);
    return courses_.back();
  }

  void pair(Course& course, int id, Timestamp time) {
    ++course.history.paired;
    ++targets_of_[id][course.history.id];
    if (course.estimate && *course.estimate != id) ++course.history.switches;
    course.estimate = id;
    if (!course.history.found_s) course.history.found_s = to_seconds(time - course.first);
  }

  std::optional<double> outlived(const Course& course) const {
    if (course.last == end_ || !course.estimate) return std::nullopt;
    const auto alone = alone_at_.find(*course.estimate);
    return alone == alone_at_.end() ? 0.0 : std::max(0.0, to_seconds(alone->second - course.last));
  }

  std::vector<Course> courses_;
  std::map<int, std::map<int, int>> targets_of_;  // by id: how often it belonged to each target
  std::map<int, Timestamp> alone_at_;             // by id: the last moment at which it belonged to none
  Timestamp end_{};
};

}  // namespace

std::vector<std::optional<std::size_t>> pair_by_place(const TargetMoment& moment, double radius_m) {
  Eigen::MatrixXd gain(moment.truth.size(), moment.estimates.size());
  for (Index i = 0; i < gain.rows(); ++i) {
    for (Index j = 0; j < gain.cols(); ++j) {
      const auto& truth = moment.truth[static_cast<std::size_t>(i)];
      const auto& estimate = moment.estimates[static_cast<std::size_t>(j)];
      gain(i, j) = radius_m * radius_m - (truth.p_world - estimate.p_world).squaredNorm();
    }
  }
  std::vector<std::optional<std::size_t>> estimate_of;
  for (const auto& column : best_assignment(gain)) {
    estimate_of.push_back(column ? std::optional(static_cast<std::size_t>(*column)) : std::nullopt);
  }
  return estimate_of;
}

TrackIdentity track_identity(std::span<const TargetMoment> moments, double radius_m) {
  if (!(radius_m > 0.0)) throw std::invalid_argument("track_identity: radius_m must be > 0 m");
  Tally tally;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    if (i > 0 && moments[i].time <= moments[i - 1].time) {
      throw std::invalid_argument("track_identity: moments are not in order of time");
    }
    tally.add(moments[i], radius_m);
  }
  return tally.result();
}

}  // namespace alidade
