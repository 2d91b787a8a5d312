// SPDX-License-Identifier: Apache-2.0
#include "app/body_pipeline.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "marker1d/marker_plane.h"

namespace alidade {
namespace {

bool is_smoothed(const BodyTrackOptions& options) {
  return options.lag_s > 0 && options.method == BodyMethod::Ours;
}

}  // namespace

void validate(const BodyTrackOptions& options) {
  if (!(options.batch_s > 0 && options.batch_s <= 1)) {
    throw std::invalid_argument(fmt::format("batch_s must be > 0 s and <= 1 s, got {}", options.batch_s));
  }
  if (!(options.lag_s >= 0 && options.lag_s <= 60)) {
    throw std::invalid_argument(fmt::format("lag_s must be 0..60 s, got {}", options.lag_s));
  }
  validate(options.ours);
  validate(options.paper);
}

void bind(OptionFields& fields, BodyTrackOptions& o) {
  fields.add_choice("method", o.method, {{"ours", BodyMethod::Ours}, {"paper", BodyMethod::Paper}},
                    "ours: a robust filter with covariance; paper: the seed paper's, frame by frame");
  fields.add("batch_s", o.batch_s, "s", "readings within this time make one pose");
  fields.add("lag_s", o.lag_s, "s", "what comes so much later still improves a pose; 0: nothing does");
  fields.add("update.gate_chi2", o.ours.update.gate_chi2, "",
             "squared whitened residual beyond which a reading is an outlier");
  fields.add("update.max_iterations", o.ours.update.max_iterations, "",
             "Gauss-Newton steps of each phase of an update");
  fields.add("start.speed_m_s", o.ours.start.speed_m_s, "m/s", "standard deviation of an unknown velocity");
  fields.add("start.rate_rad_s", o.ours.start.rate_rad_s, "rad/s", "standard deviation of an unknown turning rate");
  fields.add("start.acceleration_m_s2", o.ours.start.acceleration_m_s2, "m/s^2",
             "standard deviation of an unknown one");
  fields.add("start.acceleration_rad_s2", o.ours.start.acceleration_rad_s2, "rad/s^2",
             "standard deviation of an unknown one");
  fields.add("start.least_share", o.ours.start.least_share, "", "of the readings that must fit a start");
  fields.add("start.least_log_odds", o.ours.start.least_log_odds, "",
             "against a pose that is left out beside a better one");
  fields.add("start_window_s", o.ours.start_window_s, "s", "readings that a start may be made of");
  fields.add("most_position_sigma_m", o.ours.most_position_sigma_m, "m", "a body that is less sure is lost");
  fields.add("most_rotation_sigma_rad", o.ours.most_rotation_sigma_rad, "rad", "a body that is less sure is lost");
  fields.add("learn_reading_noise", o.ours.learn_reading_noise, "", "correct the detectors' sigma by the residuals");
  fields.add("learn_motion", o.ours.learn_motion, "", "learn the motion's noise from the motion so far");
  fields.add("paper.least_planes", o.paper.least_planes, "", "fewer are filled up by extrapolated markers");
  fields.add("paper.rejection", o.paper.rejection, "", "mean residuals beyond which a plane is left out");
  fields.add_check([&o] { validate(o); });
}

PoseDetail detail_of(const BodyTrackOptions& options) {
  return options.method == BodyMethod::Ours ? PoseDetail::Motion : PoseDetail::Pose;
}

std::string describe(const BodyTrackOptions& options) {
  if (options.method == BodyMethod::Paper) return "the seed paper's, frame by frame";
  if (!is_smoothed(options)) return "robust filter, causal";
  return fmt::format("robust filter, smoothed with a lag of {:g} s", options.lag_s);
}

BodyPipeline::BodyPipeline(std::span<const LineDetector> detectors, std::span<const RigidBody> bodies,
                           const BodyTrackOptions& options, BodyRecord& record, LiveSink live)
    : array_(detectors),
      detectors_(detectors.begin(), detectors.end()),
      options_(options),
      record_(record),
      live_(std::move(live)),
      batches_(from_seconds(options.batch_s)) {
  validate(options);
  options_.ours.start.update = options.ours.update;
  for (const RigidBody& body : bodies) {
    for (const BodyMarker& marker : body.markers) body_of_marker_[marker.id] = followers_.size();
    if (options.method == BodyMethod::Ours) {
      followers_.push_back({body, BodyTracker(array_, body, options_.ours), {}, {}});
    } else {
      followers_.push_back({body, PaperTracker(body, options_.paper), {}, {}});
    }
    if (!is_smoothed(options)) continue;
    followers_.back().smoother.emplace(std::max(1, static_cast<int>(std::lround(options.lag_s / options.batch_s))));
  }
}

bool BodyPipeline::add(const LineReading& reading) {
  const auto batch = batches_.add(reading);
  if (batch) track(*batch);
  return batch.has_value();
}

void BodyPipeline::finish() {
  if (const auto batch = batches_.finish()) track(*batch);
  for (std::size_t i = 0; i < followers_.size(); ++i) {
    if (!followers_[i].smoother) continue;
    for (const BodyEstimate& settled : followers_[i].smoother->finish()) record_.add(i, settled);
  }
}

void BodyPipeline::track(const ReadingBatch& batch) {
  for (Follower& follower : followers_) follower.readings.clear();
  for (const LineReading& reading : batch.readings) {
    const auto body = body_of_marker_.find(reading.marker);
    if (body == body_of_marker_.end()) {
      throw std::invalid_argument(fmt::format("marker {} belongs to no body", reading.marker));
    }
    followers_[body->second].readings.push_back(reading);
  }
  for (std::size_t i = 0; i < followers_.size(); ++i) {
    Follower& f = followers_[i];
    BodyEstimate now = std::visit([&](auto& tracker) { return estimate(tracker, f, batch.time); }, f.tracker);
    record_.observe(i, now, f.readings);
    if (live_) live_(f.body.name, now);
    if (!f.smoother) {
      record_.add(i, now);
      continue;
    }
    for (const BodyEstimate& settled : f.smoother->add(std::move(now))) record_.add(i, settled);
  }
}

BodyEstimate BodyPipeline::estimate(BodyTracker& tracker, const Follower& follower, Timestamp time) const {
  return tracker.track(time, follower.readings);
}

// The paper tells no reading from another: which of them its pose explains is decided as ours does.
BodyEstimate BodyPipeline::estimate(PaperTracker& tracker, const Follower& follower, Timestamp time) const {
  const auto planes = marker_planes(detectors_, follower.body, follower.readings, tracker.predicted(time));
  const PaperStep step = tracker.step(time, planes);
  BodyEstimate estimate;
  estimate.time = estimate.state.time = time;
  if (step.outcome == PaperOutcome::Lost || step.is_degenerate) return estimate;
  estimate.status = BodyStatus::Tracked;
  estimate.state.T_world_body = step.T_world_body;
  estimate.determined = step.outcome == PaperOutcome::Solved ? 6 : 0;
  for (const auto& r : residuals_of(array_, follower.body, follower.readings, estimate.state)) {
    const double chi2 = r ? r->value * r->value / (r->sigma * r->sigma) : 0.0;
    const bool fits = r && chi2 <= options_.ours.update.gate_chi2;
    estimate.is_inlier.push_back(fits);
    if (!fits) continue;
    ++estimate.inlier_count;
    estimate.chi2 += chi2;
  }
  return estimate;
}

}  // namespace alidade
