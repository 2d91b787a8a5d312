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

constexpr double kGuessDegrees = 200.0;        // how much the detectors' own sigma weighs, in readings
constexpr double kMostDegrees = 1e5;           // the noise may change in the long run
constexpr double kDropped = 15.0;              // ln of the odds against a candidate that is given up
constexpr int kMostMisfits = 5;

double largest_sigma(const Eigen::Matrix3d& covariance) {
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly).eigenvalues()(2));
}

// Whether two states cannot be told apart.
bool is_same(const MotionState& a, const MotionState& b) {
  const Vector6d off = difference(a.T_world_body, b.T_world_body);
  const Matrix6d P = a.covariance.topLeftCorner<6, 6>() + b.covariance.topLeftCorner<6, 6>();
  return off.dot(P.ldlt().solve(off)) < 9.0;
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
  BodyUpdate update = update_hypotheses(time, readings);
  const bool misfit = readings.size() >= 4 && 2 * static_cast<std::size_t>(update.inlier_count) < readings.size();
  misfits_ = misfit ? misfits_ + 1 : 0;
  if (!is_sure(hypotheses_.front().state) || misfits_ > kMostMisfits) {
    hypotheses_.clear();
    learner_.interrupt();
    return std::nullopt;
  }
  BodyEstimate estimate = answer(time);
  estimate.determined = determined_directions(update.readings.information.topLeftCorner<6, 6>());
  estimate.is_inlier = update.is_inlier;
  estimate.inlier_count = update.inlier_count;
  estimate.chi2 = update.chi2;
  if (was_certain) {
    learn(update);
    if (options_.learn_motion) learner_.add(before, update.readings);
    estimate.step = std::move(update.motion);
  }
  return estimate;
}

BodyUpdate BodyTracker::update_hypotheses(Timestamp time, std::span<const LineReading> readings) {
  std::vector<BodyUpdate> updates;
  for (Hypothesis& h : hypotheses_) {
    updates.push_back(update_body(BodyReadings(detectors_, body_, readings, variance_factor_), h.state, time,
                                  learner_.motion(), options_.update));
    h.state = updates.back().motion.state;
    h.log_evidence += updates.back().log_evidence;
  }
  const auto best = std::max_element(hypotheses_.begin(), hypotheses_.end(), [](const auto& a, const auto& b) {
    return a.log_evidence < b.log_evidence;
  });
  BodyUpdate update = std::move(updates[static_cast<std::size_t>(best - hypotheses_.begin())]);
  drop_improbable();
  return update;
}

BodyEstimate BodyTracker::answer(Timestamp time) const {
  BodyEstimate estimate;
  estimate.time = time;
  if (hypotheses_.empty()) return estimate;
  estimate.status = hypotheses_.size() == 1 ? BodyStatus::Tracked : BodyStatus::Ambiguous;
  estimate.state = hypotheses_.front().state;
  if (hypotheses_.size() == 1) return estimate;
  for (const Hypothesis& h : hypotheses_) estimate.candidates.push_back(h.state);
  return estimate;
}

BodyEstimate BodyTracker::start(Timestamp time) {
  misfits_ = 0;
  const std::vector<LineReading> readings(recent_.begin(), recent_.end());
  for (BodyCandidate& c : start_body(detectors_, body_, readings, time, variance_factor_, options_.start)) {
    if (is_sure(c.state)) hypotheses_.push_back({std::move(c.state), c.log_evidence});
  }
  BodyEstimate estimate = answer(time);
  estimate.is_start = true;
  return estimate;
}

bool BodyTracker::is_sure(const MotionState& state) const {
  return state.covariance.allFinite() &&
         largest_sigma(state.covariance.topLeftCorner<3, 3>()) <= options_.most_position_sigma_m &&
         largest_sigma(state.covariance.block<3, 3>(3, 3)) <= options_.most_rotation_sigma_rad;
}

void BodyTracker::drop_improbable() {
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.log_evidence > b.log_evidence; });
  std::vector<Hypothesis> kept;
  for (const Hypothesis& h : hypotheses_) {
    const bool is_double =
        std::any_of(kept.begin(), kept.end(), [&](const Hypothesis& k) { return is_same(k.state, h.state); });
    if (!is_double && h.log_evidence > hypotheses_.front().log_evidence - kDropped) kept.push_back(h);
  }
  hypotheses_ = std::move(kept);
}

void BodyTracker::learn(const BodyUpdate& update) {
  if (!options_.learn_reading_noise || update.degrees_of_freedom <= 0) return;
  const double known = std::min(kGuessDegrees + factor_degrees_, kMostDegrees);
  const double sum = known * variance_factor_ + variance_factor_ * update.chi2;
  factor_degrees_ += update.degrees_of_freedom;
  variance_factor_ = std::clamp(sum / (known + update.degrees_of_freedom), 1e-4, 1e4);
}

}  // namespace alidade
