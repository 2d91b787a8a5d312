// SPDX-License-Identifier: Apache-2.0
#include "app/targets/target_pipeline.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "uav/flight/receiver_clocks.h"

namespace alidade {
namespace {

PaperOptions paper_options(const TargetTrackOptions& options) {
  PaperOptions paper = options.paper;
  paper.method = options.method == TargetMethod::PaperAlternative ? PaperMethod::Alternative : PaperMethod::Proposed;
  paper.period_s = options.ours.period_s;
  return paper;
}

std::string to_string(TargetStatus status) {
  if (status == TargetStatus::Tentative) return "tentative";
  return status == TargetStatus::Confirmed ? "confirmed" : "coasting";
}

// How far the receivers' directions are off by their poses: root mean square of a coordinate.
double pose_sigma_rad(std::span<const Receiver> receivers) {
  constexpr double kUnknownPose_rad = 0.003;
  double squares = 0.0;
  for (const Receiver& receiver : receivers) {
    if (receiver.pose_covariance) {
      squares += receiver.pose_covariance->bottomRightCorner<3, 3>().trace() / 3.0;
    } else if (receiver.camera) {
      squares += kUnknownPose_rad * kUnknownPose_rad;
    }
  }
  return receivers.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(receivers.size()));
}

TargetRow row_of(const TargetState& state) {
  TargetRow row;
  row.time = state.time;
  row.p_world = state.p_world;
  row.v_world = state.v_world;
  row.covariance = state.covariance.topLeftCorner<6, 6>();
  return row;
}

}  // namespace

void validate(const TargetTrackOptions& options) {
  for (const auto& [name, value] : {std::pair("output_s", options.output_s), std::pair("period_s", options.period_s),
                                    std::pair("scan_s", options.scan_s)}) {
    if (!(value >= 0.0)) throw std::invalid_argument(fmt::format("{} must be >= 0 s, got {}", name, value));
  }
  validate(settled(options, std::nullopt).ours);
  validate(options.flight);
  validate(SteeredReceiver{Receiver{}, options.cue.slew_rad_s, options.cue.settle_s, std::nullopt});
  validate(paper_options(options));
}

void bind(OptionFields& fields, TargetTrackOptions& options) {
  TargetTrackerOptions& ours = options.ours;
  fields.add_choice("method", options.method,
                    {{"ours", TargetMethod::Ours},
                     {"flight", TargetMethod::Flight},
                     {"paper-alternative", TargetMethod::PaperAlternative},
                     {"paper-proposed", TargetMethod::PaperProposed}},
                    "a recursive tracker; one target smoothed over its whole flight, with the receivers' clocks; the "
                    "UAV paper's algorithm of two receivers; its own of three");
  fields.add("output_s", options.output_s, "s", "from one estimate to the next; 0: a period, 0.2 s at least");
  fields.add("period_s", options.period_s, "s",
             "in which each receiver looks at each target about once; 0: a frame of cameras, else 1 s");
  fields.add("scan_s", options.scan_s, "s",
             "one look: a receiver's bearings that are nearer in time are of different targets; 0: 0.4 of a camera's "
             "frame, else 0.03 s");
  fields.add("lag_s", ours.lag_s, "s", "how late a bearing may come and still be put where it belongs");
  fields.add_choice("association", ours.association,
                    {{"nearest-neighbour", ScanAssociation::NearestNeighbour}, {"joint", ScanAssociation::Joint}},
                    "bearings to targets: the most probable way (global), or all by their probability (JPDA)");
  fields.add(
      "acceleration_density", options.acceleration_density, "m2/s3",
      "how targets leave the straight path: 0.1 in steady flight, 10 for a drone that manoeuvres; below 0: 10 of "
      "cameras, else 0.1");
  fields.add(
      "added_sigma_rad", options.added_sigma_rad, "rad",
      "what bearings err by beside their own noise; below 0: by the receivers' pose covariances, 0.003 of cameras "
      "without one");
  fields.add("detection_probability", ours.detection_probability, "", "of a target in a look");
  fields.add("false_bearings_per_sr", ours.false_bearings_per_sr, "1/sr", "their mean number in a look");
  fields.add("gate_chi2", ours.gate_chi2, "", "how far off a bearing of a target may be");
  fields.add("top_speed_m_s", ours.top_speed_m_s, "m/s", "of targets that appear");
  fields.add("least_sightings", ours.least_sightings, "", "of a new target");
  fields.add("start_log_ratio", ours.start_log_ratio, "", "how sure a new one must be: ln of the probability ratio");
  fields.add("confirm_log_ratio", ours.confirm_log_ratio, "", "the same until it is taken for real");
  fields.add("patience_periods", ours.patience_periods, "", "a target that nobody has seen so long is given up");
  fields.add("temperature_sigma_k", ours.temperature_sigma_k, "K",
             "of a reading about its target's; above 0 temperatures help to tell targets apart");
  fields.add("cue.slew_rad_s", options.cue.slew_rad_s, "rad/s", "how fast receivers turn that are cued");
  fields.add("cue.settle_s", options.cue.settle_s, "s", "how long they then take until they can read");
  fields.add("flight.step_s", options.flight.step_s, "s", "between the states of a flight");
  fields.add("flight.acceleration_m_s2", options.flight.acceleration_m_s2, "m/s2", "of each coordinate, typically");
  fields.add("flight.acceleration_time_s", options.flight.acceleration_time_s, "s", "how long it goes on as it does");
  fields.add("flight.turn_rad", options.flight.turn_rad, "rad",
             "how far directions of a receiver without covariance are off");
  fields.add("paper.periods", options.paper.periods, "", "of a window of the paper's method");
  fields.add("paper.pair_threshold_m", options.paper.pair_threshold_m, "m", "how far two lines of sight may pass");
  fields.add("paper.alternative_group_m", options.paper.alternative_group_m, "m", "of a continuation from its group");
  fields.add("paper.proposed_group_m", options.paper.proposed_group_m, "m", "likewise");
  fields.add("paper.shared_bearings", options.paper.shared_bearings, "", "that two objects may have in common");
  fields.add_check([&options] { validate(options); });
}

TargetTrackOptions settled(TargetTrackOptions options, std::optional<double> frame_interval_s,
                           std::span<const Receiver> receivers) {
  constexpr double kSteady = 0.1, kDrone = 10.0;
  constexpr double kDirectionFinder_s = 1.0, kDirectionFinderScan_s = 0.03, kShareOfFrame = 0.4;
  TargetTrackerOptions& ours = options.ours;
  const double frame_s = frame_interval_s.value_or(kDirectionFinder_s);
  if (options.period_s == 0.0) options.period_s = frame_s;
  if (options.scan_s == 0.0) options.scan_s = frame_interval_s ? kShareOfFrame * frame_s : kDirectionFinderScan_s;
  if (options.output_s == 0.0) options.output_s = std::max(0.2, options.period_s);
  if (options.acceleration_density < 0.0) options.acceleration_density = frame_interval_s ? kDrone : kSteady;
  if (options.added_sigma_rad < 0.0) options.added_sigma_rad = pose_sigma_rad(receivers);
  ours.filter.motion.acceleration_density = options.acceleration_density;
  ours.filter.added_sigma_rad = options.added_sigma_rad;
  ours.period_s = options.period_s;
  ours.scan_s = options.scan_s;
  if (frame_interval_s) {
    ours.least_sightings = std::max(ours.least_sightings, 9);
    ours.window_periods = std::max(ours.window_periods, 10.0);
    ours.patience_periods = std::max(ours.patience_periods, 20.0);
  }
  return options;
}

std::string describe(const TargetTrackOptions& options) {
  switch (options.method) {
    case TargetMethod::PaperAlternative:
      return "the UAV paper's alternative algorithm (two receivers)";
    case TargetMethod::PaperProposed:
      return "the UAV paper's proposed algorithm (three receivers)";
    case TargetMethod::Flight:
      return "one target, smoothed over the whole flight, with the receivers' clocks and directions";
    case TargetMethod::Ours:
      break;
  }
  return fmt::format("extended Kalman filters on bearings in order of time, {}",
                     options.ours.association == ScanAssociation::Joint ? "joint probabilistic data association"
                                                                        : "global nearest neighbour");
}

TargetRow row_of(const TargetEstimate& estimate) {
  TargetRow row = row_of(estimate.state);
  row.target = estimate.id;
  row.state = to_string(estimate.status);
  row.sightings = estimate.sightings;
  if (estimate.temperature_readings > 0) {
    row.temperature_k = estimate.temperature_mean_k;
    row.temperature_sigma_k = estimate.temperature_spread_k;
  }
  return row;
}

TargetRow row_of(const PaperTarget& target) {
  TargetRow row = row_of(target.state);
  row.target = target.id;
  row.state = "confirmed";
  row.sightings = static_cast<std::int64_t>(target.bearings.size());
  return row;
}

TargetPipeline::TargetPipeline(const TargetTrackOptions& options, TargetRecord& record, LiveSink live, CueSink cue)
    : options_(options), record_(record), live_(std::move(live)), cue_(std::move(cue)), tracker_(options.ours) {}

void TargetPipeline::add(const Bearing& bearing) {
  record_.observe(bearing);
  if (options_.method != TargetMethod::Ours) {
    bearings_.push_back(bearing);
    return;
  }
  if (!next_output_) next_output_ = next_live_ = bearing.time + from_seconds(options_.output_s);
  // What lies before the newest bearing is complete but for late ones.
  while ((live_ || cue_) && bearing.time > *next_live_) tell_newest();
  tracker_.add(bearing);
  write_until(tracker_.now() - from_seconds(options_.ours.lag_s));
}

void TargetPipeline::finish() {
  if (options_.method == TargetMethod::Flight) return write_flight();
  if (options_.method != TargetMethod::Ours) {
    for (const PaperTarget& target : track_paper_targets(bearings_, paper_options(options_))) {
      record_.add(row_of(target));
    }
    return;
  }
  if (!next_output_) return;
  if ((live_ || cue_) && *next_live_ <= tracker_.now()) tell_newest();
  write_until(tracker_.now());
}

void TargetPipeline::write_flight() {
  const std::vector<Receiver>& receivers = record_.run().receivers;
  const auto path = estimate_flight(receivers, bearings_, options_.flight);
  if (!path) return;
  const Timestamp begin = path->steps.front().state.time, end = path->steps.back().state.time;
  for (Timestamp t = begin; t <= end; t += from_seconds(options_.output_s)) {
    const FlightStep* step = step_at(*path, t);
    if (!step || step->seen_by < 2) continue;
    TargetRow row = row_of(*state_at(*path, t));
    row.target = 1;
    row.state = "confirmed";
    row.sightings = step->seen_by;
    record_.add(row);
  }
  receivers_in_operation_ = receivers;
  if (path->steps.size() < 2) return;
  const std::vector<ReceiverClock> clocks = clocks_in_operation(receivers, *path, begin, end);
  for (std::size_t i = 0; i < clocks.size(); ++i) receivers_in_operation_[i].clock = clocks[i];
}

void TargetPipeline::write_until(Timestamp time) {
  for (; *next_output_ <= time; *next_output_ += from_seconds(options_.output_s)) {
    for (const TargetEstimate& estimate : tracker_.estimates_at(*next_output_)) {
      if (estimate.status != TargetStatus::Tentative) record_.add(row_of(estimate));
    }
  }
}

void TargetPipeline::tell_newest() {
  const std::vector<TargetEstimate> targets = tracker_.estimates_at(*next_live_);
  if (live_) live_(*next_live_, targets);
  if (cue_) {
    const auto cues =
        cues_for(record_.run().receivers, targets, *next_live_, options_.cue, options_.ours.filter.motion);
    for (const AddressedCue& cue : cues) cue_(cue);
  }
  *next_live_ += from_seconds(options_.output_s);
}

}  // namespace alidade
