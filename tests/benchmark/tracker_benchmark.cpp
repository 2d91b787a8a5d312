// SPDX-License-Identifier: Apache-2.0
// The tracker of flying targets: one update of a filter with a bearing, one scan of several targets, per target, and
// bearings from arrival to answer. One thread.

#include <benchmark/benchmark.h>

#include "datasets/target_scene.h"
#include "uav/tracker/scan_association.h"
#include "uav/tracker/target_tracker.h"
#include "uav/tracker/track_book.h"

namespace alidade {
namespace {

struct Recording {
  TargetScene scene;
  std::vector<Bearing> bearings;
};

Recording record(int targets, int periods) {
  TargetSceneOptions options;
  options.targets = targets;
  options.periods = periods;
  options.detection_probability = 0.95;
  options.false_bearings = 0.5;
  options.spread_m = 40.0;
  Recording recording{make_target_scene(options), {}};
  recording.bearings = bearings_of(recording.scene.receivers, recording.scene.readings);
  return recording;
}

// The tracks of all targets after nine periods, and a scan of the tenth that sees them all.
struct Moment {
  std::vector<TargetTrack> tracks;
  BearingScan scan;
  TargetTrackerOptions options;
};

Moment moment_of(int targets, ScanAssociation association) {
  const Recording recording = record(targets, 12);
  Moment moment;
  moment.options.association = association;
  TrackBook book;
  for (const BearingScan& scan : scans_of(recording.bearings, moment.options.scan_s)) {
    const bool is_full = std::ssize(scan.bearings) >= targets && std::ssize(book.tracks) >= targets;
    if (is_full && to_seconds(scan.begin() - Timestamp{}) >= 9.0) {
      moment.tracks = book.tracks;
      moment.scan = scan;
      break;
    }
    book = after_scan(std::move(book), scan, moment.options);
  }
  return moment;
}

// Prediction, innovation, update.
void filter_update(benchmark::State& run) {
  const Moment moment = moment_of(1, ScanAssociation::NearestNeighbour);
  if (moment.tracks.empty()) return run.SkipWithError("no target was found");
  const TargetState& state = moment.tracks.front().state;
  const Bearing& bearing = moment.scan.bearings.front();
  const BearingFilterOptions& options = moment.options.filter;
  for (auto _ : run) {
    const TargetState predicted = predict(state, bearing.time, options.motion);
    benchmark::DoNotOptimize(absorb(predicted, bearing, *innovation_of(predicted, bearing), options));
  }
}
BENCHMARK(filter_update);

// Gates, association and updates of a scan. Items: targets.
void scan_update(benchmark::State& run, ScanAssociation association) {
  const auto targets = static_cast<int>(run.range(0));
  const Moment moment = moment_of(targets, association);
  if (std::ssize(moment.tracks) < targets) return run.SkipWithError("not all targets were found");
  for (auto _ : run) benchmark::DoNotOptimize(take_scan(moment.tracks, moment.scan, moment.options));
  run.SetItemsProcessed(run.iterations() * targets);
}
BENCHMARK_CAPTURE(scan_update, nearest, ScanAssociation::NearestNeighbour)->Arg(2)->Arg(5)->Arg(10);
BENCHMARK_CAPTURE(scan_update, joint, ScanAssociation::Joint)->Arg(2)->Arg(5)->Arg(10);

// Twenty periods from the first bearing on, new tracks and an answer per bearing included. Items: bearings.
void from_bearing_to_answer(benchmark::State& run) {
  const Recording recording = record(static_cast<int>(run.range(0)), 20);
  for (auto _ : run) {
    TargetTracker tracker;
    for (const Bearing& bearing : recording.bearings) {
      tracker.add(bearing);
      benchmark::DoNotOptimize(tracker.estimates_at(tracker.now()));
    }
  }
  run.SetItemsProcessed(run.iterations() * std::ssize(recording.bearings));
}
BENCHMARK(from_bearing_to_answer)->Arg(2)->Arg(5)->Arg(10)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace alidade

BENCHMARK_MAIN();
