// SPDX-License-Identifier: Apache-2.0
#include "marker1d/paper_tracker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "geometry/pose.h"

namespace alidade {
namespace {

template <class Value>
void require(bool holds, const char* field, Value value, const char* bound) {
  if (!holds) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
}

void require_markers(const RigidBody& body, std::span<const MarkerPlane> planes) {
  const int count = static_cast<int>(body.markers.size());
  for (const MarkerPlane& plane : planes) {
    require(plane.marker >= 0 && plane.marker < count, "MarkerPlane::marker", plane.marker, "one of the body's");
  }
}

std::vector<double> distances(const RigidBody& body, const Eigen::Isometry3d& T_world_body,
                              std::span<const MarkerPlane> planes) {
  std::vector<double> distances;
  distances.reserve(planes.size());
  for (const MarkerPlane& plane : planes) {
    const Eigen::Vector3d& p_body = body.markers[static_cast<std::size_t>(plane.marker)].p_body;
    distances.push_back(std::abs(distance(plane.plane_world, T_world_body * p_body)));
  }
  return distances;
}

// What was extrapolated for t is off by about t², hence of a variance as t⁴. The shares of two that were not: a half.
double share_of_backward(double forward_unseen_s, double backward_unseen_s) {
  const double forward = std::pow(forward_unseen_s, 4), backward = std::pow(backward_unseen_s, 4);
  return forward + backward > 0 ? forward / (forward + backward) : 0.5;
}

PaperStep average(const PaperStep& forward, const PaperStep& backward) {
  if (forward.outcome == PaperOutcome::Lost) return backward;
  if (backward.outcome == PaperOutcome::Lost) return forward;
  PaperStep refined = backward.outcome < forward.outcome ? backward : forward;
  refined.T_world_body =
      interpolate(forward.T_world_body, backward.T_world_body, share_of_backward(forward.unseen_s, backward.unseen_s));
  refined.unseen_s = std::min(forward.unseen_s, backward.unseen_s);
  return refined;
}

}  // namespace

void validate(const PaperTrackerOptions& options) {
  require(options.least_planes >= 6, "least_planes", options.least_planes, ">= 6");
  require(options.rejection > 1, "rejection", options.rejection, "> 1");
  require(options.memory >= 3, "memory", options.memory, ">= 3");
  require(options.least_spread >= 0 && options.least_spread < 1, "least_spread", options.least_spread, ">= 0 and < 1");
  require(options.newton.max_steps >= 1, "newton.max_steps", options.newton.max_steps, ">= 1");
  require(options.newton.last_step > 0, "newton.last_step", options.newton.last_step, "> 0");
}

PaperTracker::PaperTracker(RigidBody body, const PaperTrackerOptions& options)
    : body_(std::move(body)), options_(options), motion_(options.memory) {
  validate(options);
  if (body_.markers.empty()) throw std::invalid_argument("PaperTracker: the body has no marker");
}

void PaperTracker::start(Timestamp time, const Eigen::Isometry3d& T_world_body) {
  motion_.clear();
  motion_.add(time, T_world_body);
  solved_ = time;
}

std::optional<Eigen::Isometry3d> PaperTracker::predicted(Timestamp time) const {
  if (motion_.is_empty()) return std::nullopt;
  return motion_.pose_at(time);
}

PaperStep PaperTracker::step(Timestamp time, std::span<const MarkerPlane> planes) {
  require_markers(body_, planes);
  PaperStep step;
  step.time = time;
  step.plane_count = static_cast<int>(planes.size());
  const bool is_short = step.plane_count < options_.least_planes;
  const auto pose = is_short ? solve_twice(with_padding(time, planes), step) : solve_twice(planes, step);
  if (pose) {
    step.outcome = is_short ? PaperOutcome::Padded : PaperOutcome::Solved;
    step.T_world_body = *pose;
    motion_.add(time, *pose);
    if (!is_short) solved_ = time;
  } else if (const auto expected = predicted(time)) {
    step.outcome = PaperOutcome::Extrapolated;
    step.T_world_body = *expected;
  }
  if (solved_) step.unseen_s = std::abs(to_seconds(time - *solved_));
  return step;
}

// Item 2: three planes through where each unseen marker should be; where that is not enough, through those seen least.
std::vector<MarkerPlane> PaperTracker::with_padding(Timestamp time, std::span<const MarkerPlane> planes) const {
  std::vector<MarkerPlane> filled(planes.begin(), planes.end());
  if (motion_.is_empty()) return filled;
  std::vector<int> seen(body_.markers.size(), 0);
  double weight = planes.empty() ? 1.0 : 0.0;
  for (const MarkerPlane& plane : planes) {
    ++seen[static_cast<std::size_t>(plane.marker)];
    weight += plane.weight / static_cast<double>(planes.size());
  }
  const int most = *std::max_element(seen.begin(), seen.end());
  for (int count = 0; count <= most; ++count) {
    if (count > 0 && static_cast<int>(filled.size()) >= options_.least_planes) break;
    for (std::size_t m = 0; m < seen.size(); ++m) {
      if (seen[m] != count) continue;
      const Eigen::Vector3d p_world = motion_.point_at(time, body_.markers[m].p_body);
      for (int axis = 0; axis < 3; ++axis) {
        filled.push_back({static_cast<int>(m), {Eigen::Vector3d::Unit(axis), p_world(axis)}, weight});
      }
    }
  }
  return filled;
}

// Items 1 and 3.
std::optional<Eigen::Isometry3d> PaperTracker::solve_twice(std::span<const MarkerPlane> planes, PaperStep& step) const {
  const auto expected = predicted(step.time);
  PaperSums sums(body_, expected ? expected->translation() : Eigen::Vector3d(0, 0, 0));
  for (const MarkerPlane& plane : planes) sums.add(plane, weight_of(plane));
  const auto first = solve(sums, expected, step);
  if (!first || planes.empty()) return first;
  const std::vector<double> off = distances(body_, *first, planes);
  double mean = 0.0;
  for (const double d : off) mean += d / static_cast<double>(off.size());
  int rejected = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (off[i] <= options_.rejection * mean) continue;
    sums.remove(planes[i], weight_of(planes[i]));
    ++rejected;
  }
  if (rejected == 0 || static_cast<int>(planes.size()) - rejected < options_.least_planes) return first;
  const auto cost = eliminate_translation(sums);
  if (!cost) return first;
  const auto second = solve_paper_pose(*cost, first->linear(), options_.newton);
  if (!second || !second->is_minimum) return first;
  step.rejected_count = rejected;
  return second->T_world_body;
}

std::optional<Eigen::Isometry3d> PaperTracker::solve(const PaperSums& sums,
                                                     const std::optional<Eigen::Isometry3d>& expected,
                                                     PaperStep& step) const {
  const auto cost = eliminate_translation(sums);
  step.is_degenerate = !cost || cost->spread < options_.least_spread;
  if (!cost) return std::nullopt;
  std::optional<PaperPose> pose;
  if (expected) pose = solve_paper_pose(*cost, expected->linear(), options_.newton);
  if (pose && !pose->is_minimum) pose.reset();
  if (!pose && step.plane_count >= options_.least_planes) pose = start_paper_pose(*cost, options_.newton);
  if (!pose) return std::nullopt;
  step.newton_steps = pose->steps;
  return pose->T_world_body;
}

std::vector<PaperStep> refine_backward(const RigidBody& body, std::span<const PaperFrame> frames,
                                       std::span<const PaperStep> forward, const PaperTrackerOptions& options) {
  if (frames.size() != forward.size()) throw std::invalid_argument("refine_backward: one step per frame, please");
  std::vector<PaperStep> refined(forward.begin(), forward.end());
  PaperTracker tracker(body, options);
  for (std::size_t i = frames.size(); i-- > 0;) {
    const PaperFrame& frame = frames[i];
    if (!tracker.predicted(frame.time)) {
      if (forward[i].outcome != PaperOutcome::Solved) continue;
      tracker.start(frame.time, forward[i].T_world_body);
    }
    refined[i] = average(forward[i], tracker.step(frame.time, frame.planes));
  }
  return refined;
}

}  // namespace alidade
