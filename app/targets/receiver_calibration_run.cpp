// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/errors.h"
#include "core/find_by_id.h"

namespace alidade {
namespace {

using Readings = std::vector<ReceiverReading>;

constexpr double kBlocksForDeviations = 2.0 * kReceiverParameters;

Readings readings_of(const ReceiverCalibrationInput& input, int receiver) {
  Readings own;
  std::copy_if(input.readings.begin(), input.readings.end(), std::back_inserter(own),
               [&](const ReceiverReading& reading) { return reading.receiver == receiver; });
  return own;
}

PathLookup lookup(const KnownTrack& track) {
  return [&track](double t_s) { return track.at(t_s); };
}

double span_s(const Readings& readings) {  // in order of time
  return readings.empty() ? 0.0 : to_seconds(readings.back().time - readings.front().time);
}

// A covariance takes more blocks of time than parameters are found: in a short flight they are shorter.
ResectionOptions fitted_to(const Readings& readings, ResectionOptions options) {
  options.block_s = std::max(1e-3, std::min(options.block_s, span_s(readings) / kBlocksForDeviations));
  return options;
}

// A receiver that can be, and explains its readings about as well as the given one at least.
bool is_credible(const ResectedReceiver& resected, const ReceiverResiduals& before) {
  constexpr double kWorse = 1.5;  // outliers weigh differently; a lost search is off by hundreds of pixels
  if (find_fault(resected.receiver)) return false;
  return !before.median_px || resected.median_px < kWorse * *before.median_px;
}

// Short flights tell too little for the search, a rolling shutter or a rate: first the search is left out, then these.
std::optional<ResectedReceiver> credible_resection(const CalibratedReceiver& one, const Readings& readings,
                                                   const KnownTrack& track, const ResectionOptions& options) {
  for (const bool keep_pose : {options.keep_pose, true}) {
    ResectionOptions attempt = options;
    attempt.keep_pose = keep_pose;
    for (bool* found : {static_cast<bool*>(nullptr), &attempt.find_readout, &attempt.find_rate}) {
      if (found) *found = false;
      auto resected = resect_receiver(one.given, readings, track, attempt);
      if (resected && is_credible(*resected, one.before)) return resected;
    }
  }
  return std::nullopt;
}

void resect(CalibratedReceiver& one, const Readings& readings, const KnownTrack& track,
            const ResectionOptions& options) {
  one.before = residuals_about(lookup(track), one.given, readings);
  const auto resected = credible_resection(one, readings, track, fitted_to(readings, options));
  if (!resected) {
    one.left_why = one.before.readings < options.least_readings
                       ? fmt::format("{} of its readings lie on the path, wanted are {}", one.before.readings,
                                     options.least_readings)
                       : "no pose and clock explain its readings, or they tell too little of them";
    one.after = one.before;
    return;
  }
  one.found = resected->receiver;
  one.sigma = resected->sigma;
  one.wander_px = resected->wander_px;
  one.change = change_between(one.given, one.found);
  one.after = residuals_about(lookup(track), one.found, readings);
}

// The part of the known path that the readings were made in.
std::vector<TimedPosition> part_seen(const ReceiverCalibrationInput& input, const ReceiverCalibrationRun& run) {
  double begin_s = std::numeric_limits<double>::infinity(), end_s = -begin_s;
  for (const CalibratedReceiver& one : run.receivers) {
    for (const SightResidualSample& sample : one.after.samples) {
      begin_s = std::min(begin_s, sample.t_s);
      end_s = std::max(end_s, sample.t_s);
    }
  }
  std::vector<TimedPosition> part;
  for (const TimedPosition& position : input.truth) {
    const double t_s = to_seconds(position.time.time_since_epoch());
    if (t_s >= begin_s && t_s <= end_s) part.push_back(position);
  }
  return part;
}

void warn_of_short_flights(const ReceiverCalibrationInput& input, const ResectionOptions& options,
                           ReceiverCalibrationRun& run) {
  double longest_s = 0.0;
  for (const Receiver& camera : input.cameras()) {
    longest_s = std::max(longest_s, span_s(readings_of(input, camera.id)));
  }
  if (longest_s < kBlocksForDeviations * options.block_s) {
    run.warnings.push_back(fmt::format(
        "the readings span {:.0f} s only: standard deviations may be too small, and faults be overlooked; they want "
        "{:.0f} s",
        longest_s, kBlocksForDeviations * options.block_s));
  }
}

void resect_all(const ReceiverCalibrationInput& input, const ReceiverCalibrationChoice& choice,
                const CalibrationWatch& watch, ReceiverCalibrationRun& run) {
  const KnownTrack track(input.truth);
  const auto total = static_cast<std::int64_t>(input.cameras().size());
  std::int64_t done = 0;
  for (CalibratedReceiver& one : run.receivers) {
    if (!one.given.camera) continue;
    if (watch.progress) watch.progress({"resecting (cameras)", done++, total, ""});
    if (watch.stop.stop_requested()) {
      one.left_why = "interrupted";
      run.is_interrupted = true;
    } else {
      resect(one, readings_of(input, one.given.id), track, choice.resection);
    }
  }
  run.path = part_seen(input, run);
  if (!run.has_answer()) return;
  run.is_interrupted = watch.stop.stop_requested();
  if (run.is_interrupted) return;
  warn_of_short_flights(input, choice.resection, run);
  if (watch.progress) watch.progress({"looking for faults (cameras)", 0, total, ""});
  ReceiverCheckOptions checks = choice.checks;
  checks.search_s = choice.resection.search_s;
  run.findings = check_receivers(input.cameras(), input.readings, track, checks);
  if (watch.progress) watch.progress({"looking for faults (cameras)", total, total, ""});
}

std::vector<TimedPosition> sampled(const SplinePath& path, const ReceiverCalibrationRun& run) {
  constexpr double kStep_s = 0.1;
  double begin_s = path.end_s(), end_s = path.begin_s;  // of what was seen
  for (const CalibratedReceiver& one : run.receivers) {
    for (const SightResidualSample& sample : one.after.samples) {
      begin_s = std::min(begin_s, sample.t_s);
      end_s = std::max(end_s, sample.t_s);
    }
  }
  std::vector<TimedPosition> positions;
  for (auto i = static_cast<std::int64_t>(std::ceil(begin_s / kStep_s));; ++i) {
    const double t_s = static_cast<double>(i) * kStep_s;
    const auto point = t_s <= end_s ? path.at(t_s) : std::nullopt;
    if (!point) return positions;
    positions.push_back({Timestamp(from_seconds(t_s)), point->p_world});
  }
}

// The id of the camera whose clock stands.
std::optional<int> time_receiver_of(const std::vector<Receiver>& cameras, const ReceiverCalibrationInput& input,
                                    const std::string& name) {
  if (name.empty()) return std::nullopt;
  for (const Receiver& camera : cameras) {
    if (camera.name == name) return camera.id;
  }
  throw InputError(input.sources.receivers, 0, fmt::format("no camera '{}' that saw anything", name),
                   "change --time-receiver");
}

void bundle_all(const ReceiverCalibrationInput& input, const ReceiverCalibrationChoice& choice,
                const CalibrationWatch& watch, ReceiverCalibrationRun& run) {
  std::vector<Receiver> cameras = input.cameras();
  std::erase_if(cameras, [&](const Receiver& camera) { return readings_of(input, camera.id).empty(); });
  SplineBundleOptions options = choice.bundle;
  options.time_receiver = time_receiver_of(cameras, input, choice.time_receiver);
  if (watch.progress) watch.progress({"finding path and cameras together", 0, 0, ""});
  run.is_interrupted = watch.stop.stop_requested();
  const auto bundle = run.is_interrupted ? std::nullopt : bundle_flight(cameras, input.readings, options);
  for (CalibratedReceiver& one : run.receivers) {
    if (!one.given.camera) continue;
    const Readings readings = readings_of(input, one.given.id);
    if (!bundle || readings.empty()) {
      one.left_why = run.is_interrupted ? "interrupted"
                     : readings.empty() ? "it saw nothing"
                                        : "its lines of sight meet no other camera's";
      continue;
    }
    one.found = *find_by_id(std::span<const Receiver>(bundle->receivers), one.given.id);
    if (const auto fault = find_fault(one.found)) {
      one.found = one.given;
      one.left_why = *fault;
    }
    one.change = change_between(one.given, one.found);
    const PathLookup path = [&](double t_s) { return bundle->path.at(t_s); };
    one.before = residuals_about(path, one.given, readings);
    one.after = residuals_about(path, one.found, readings);
  }
  if (bundle) run.path = sampled(bundle->path, run);
}

}  // namespace

bool ReceiverCalibrationRun::has_answer() const {
  return std::any_of(receivers.begin(), receivers.end(), [](const auto& one) { return one.is_calibrated(); });
}

std::string name_of(const Receiver& receiver) {
  return receiver.name.empty() ? fmt::format("receiver {}", receiver.id) : receiver.name;
}

ReceiverChange change_between(const Receiver& given, const Receiver& found) {
  ReceiverChange change = ReceiverChange::Zero();
  change.head<6>() = difference(given.T_world_receiver, found.T_world_receiver);
  const Timestamp reference = found.clock.reference;
  change[kClockOffset] = to_seconds(common_time(found.clock, reference) - common_time(given.clock, reference));
  change[kClockRate] = found.clock.rate - given.clock.rate;
  if (given.camera && found.camera) {
    change[kReadout] = found.camera->readout_s - given.camera->readout_s;
    change[kFocal] = std::log(found.camera->fx / given.camera->fx);
  }
  return change;
}

ReceiverCalibrationRun calibrate_receivers(const ReceiverCalibrationInput& input,
                                           const ReceiverCalibrationChoice& choice, const CalibrationWatch& watch) {
  ReceiverCalibrationRun run;
  run.sources = input.sources;
  for (const Receiver& receiver : input.receivers) {
    CalibratedReceiver one;
    one.given = one.found = receiver;
    if (!receiver.camera) one.left_why = "it is a direction finder; only cameras can be calibrated";
    run.receivers.push_back(std::move(one));
  }
  const auto begin = std::chrono::steady_clock::now();
  if (run.has_truth()) {
    resect_all(input, choice, watch, run);
  } else {
    bundle_all(input, choice, watch, run);
  }
  run.calibration_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return run;
}

}  // namespace alidade
