// SPDX-License-Identifier: Apache-2.0
#include "marker1d/body_tracker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "geometry/plane_pose.h"

namespace alidade {
namespace {

constexpr double kGuessDegrees = 200.0;  // how much the detectors' own sigma weighs, in readings
constexpr double kMostDegrees = 1e5;     // the noise may change in the long run
constexpr double kDropped = 15.0;        // ln of the odds against a candidate that is given up
constexpr double kDoubtful = 7.0;        // and against one that is still named
constexpr std::size_t kMostHypotheses = 8;
constexpr int kMostMisfits = 2;
constexpr double kLeastOfUsual = 0.5;  // of the readings that usually fit: a batch with fewer does not

double largest_sigma(const Eigen::Matrix3d& covariance) {
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly).eigenvalues()(2));
}

}  // namespace

void validate(const BodyTrackerOptions& options) {
  const auto require = [](bool holds, const char* field, double value, const char* bound) {
    if (!holds) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
  };
  require(options.update.gate_chi2 > 1, "gate_chi2", options.update.gate_chi2, "> 1");
  require(options.update.max_iterations >= 1, "max_iterations", options.update.max_iterations, ">= 1");
  require(options.start_window_s >= 0 && options.start_window_s <= 1, "start_window_s", options.start_window_s,
          "0..1 s");
  require(options.most_position_sigma_m > 0, "most_position_sigma_m", options.most_position_sigma_m, "> 0 m");
  require(options.most_rotation_sigma_rad > 0, "most_rotation_sigma_rad", options.most_rotation_sigma_rad, "> 0 rad");
}

BodyTracker::BodyTracker(const DetectorArray& detectors, RigidBody body, const BodyTrackerOptions& options)
    : detectors_(detectors), body_(std::move(body)), options_(options) {
  validate(options);
}

BodyEstimate BodyTracker::track(Timestamp time, std::span<const LineReading> readings) {
  recent_.insert(recent_.end(), readings.begin(), readings.end());
  while (!recent_.empty() && to_seconds(time - recent_.front().time) > options_.start_window_s &&
         recent_.size() > readings.size()) {
    recent_.pop_front();
  }
  if (!hypotheses_.empty()) {
    if (auto estimate = follow(time, readings)) return std::move(*estimate);
  }
  return start(time);
}

std::optional<BodyEstimate> BodyTracker::follow(Timestamp time, std::span<const LineReading> readings) {
  if (!learner_.is_started()) {
    learner_.start(std::clamp(to_seconds(time - hypotheses_.front().state.time), 1e-4, 0.1));
  }
  const bool was_certain = hypotheses_.size() == 1;
  const MotionState before = hypotheses_.front().state;
  Branch branch = update_hypotheses(time, readings);
  BodyUpdate& update = branch.update;
  if (!readings.empty() && is_nearly_linear(update.motion.predicted)) {
    share_ += 0.01 * (update.inlier_count / static_cast<double>(readings.size()) - share_);
  }
  const double least = kLeastOfUsual * share_ * static_cast<double>(readings.size());
  const bool misfit = readings.size() >= 4 && update.inlier_count < least;
  misfits_ = misfit || is_misfit(update) ? misfits_ + 1 : 0;
  if (!is_sure(hypotheses_.front().state, options_.lost_factor) || misfits_ > kMostMisfits) {
    hypotheses_.clear();
    learner_.interrupt();
    return std::nullopt;
  }
  BodyEstimate estimate = answer(time);
  estimate.determined = determined_directions(update.readings.information.topLeftCorner<6, 6>());
  estimate.is_inlier = update.is_inlier;
  estimate.inlier_count = update.inlier_count;
  estimate.chi2 = update.chi2;
  if (was_certain && hypotheses_.size() == 1) {
    learn(update);
    if (options_.learn_motion) learner_.add(before, update.readings);
  } else {
    learner_.interrupt();
  }
  if (branch.of_the_most_probable) estimate.step = std::move(update.motion);
  return estimate;
}

std::vector<BodyTracker::Branch> BodyTracker::branches(const BodyReadings& readings, Timestamp time,
                                                       std::span<const Eigen::Isometry3d> others) const {
  std::vector<Branch> branches;
  for (std::size_t parent = 0; parent < hypotheses_.size(); ++parent) {
    const Hypothesis& h = hypotheses_[parent];
    for (BodyUpdate& update :
         update_body_everywhere(readings, h.state, time, learner_.motion(), options_.update, others)) {
      const double log_evidence = h.log_evidence + update.log_evidence;
      branches.push_back({std::move(update), log_evidence, parent == 0});
    }
  }
  std::stable_sort(branches.begin(), branches.end(),
                   [](const Branch& a, const Branch& b) { return a.log_evidence > b.log_evidence; });
  return branches;
}

// Fewer fit than usual, where the body is not so well known that these must be wrong.
bool BodyTracker::is_misfit(const BodyUpdate& update) const {
  const auto n = static_cast<double>(update.is_inlier.size());
  const double expected = share_ * n - 3.0 * std::sqrt(share_ * (1.0 - share_) * n) - 1.0;
  return update.inlier_count < expected && !is_nearly_linear(update.motion.predicted);
}

BodyTracker::Branch BodyTracker::update_hypotheses(Timestamp time, std::span<const LineReading> readings) {
  const BodyReadings linearisable(detectors_, body_, readings, variance_factor_);
  std::vector<Branch> found = branches(linearisable, time, {});
  if (is_misfit(found.front().update)) {
    found = branches(linearisable, time, poses_by_planes(detectors_, body_, readings));
  }
  hypotheses_.clear();
  for (const Branch& b : found) {
    if (hypotheses_.size() == kMostHypotheses || b.log_evidence < found.front().log_evidence - kDropped) break;
    const bool is_double = std::any_of(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& known) {
      return is_same(known.state, b.update.motion.state);
    });
    if (!is_double) hypotheses_.push_back({b.update.motion.state, b.log_evidence - found.front().log_evidence});
  }
  return std::move(found.front());
}

BodyEstimate BodyTracker::answer(Timestamp time) const {
  BodyEstimate estimate;
  estimate.time = time;
  if (hypotheses_.empty()) return estimate;
  estimate.status = is_sure(hypotheses_.front().state, 1.0) ? BodyStatus::Tracked : BodyStatus::Lost;
  estimate.state = hypotheses_.front().state;
  for (const Hypothesis& h : hypotheses_) {
    if (h.log_evidence > hypotheses_.front().log_evidence - kDoubtful) estimate.candidates.push_back(h.state);
  }
  if (estimate.candidates.size() == 1) {
    estimate.candidates.clear();
  } else if (estimate.status == BodyStatus::Tracked) {
    estimate.status = BodyStatus::Ambiguous;
  }
  return estimate;
}

BodyEstimate BodyTracker::start(Timestamp time) {
  misfits_ = 0;
  const std::vector<LineReading> readings(recent_.begin(), recent_.end());
  for (BodyCandidate& c : start_body(detectors_, body_, readings, time, variance_factor_, options_.start)) {
    if (is_sure(c.state, 1.0)) hypotheses_.push_back({std::move(c.state), c.log_evidence});
  }
  BodyEstimate estimate = answer(time);
  estimate.is_start = true;
  return estimate;
}

bool BodyTracker::is_sure(const MotionState& state, double factor) const {
  return state.covariance.allFinite() &&
         largest_sigma(state.covariance.topLeftCorner<3, 3>()) <= factor * options_.most_position_sigma_m &&
         largest_sigma(state.covariance.block<3, 3>(3, 3)) <= factor * options_.most_rotation_sigma_rad;
}

void BodyTracker::learn(const BodyUpdate& update) {
  if (!options_.learn_reading_noise || update.degrees_of_freedom <= 0) return;
  const double known = std::min(kGuessDegrees + factor_degrees_, kMostDegrees);
  const double sum = known * variance_factor_ + variance_factor_ * update.chi2;
  factor_degrees_ += update.degrees_of_freedom;
  variance_factor_ = std::clamp(sum / (known + update.degrees_of_freedom), 1e-4, 1e4);
}

}  // namespace alidade
