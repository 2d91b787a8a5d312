// SPDX-License-Identifier: Apache-2.0
#include <mutex>

#include <Eigen/Cholesky>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "app/experiments/targets_experiment.h"
#include "datasets/target_scene.h"
#include "evaluation/error_consistency.h"
#include "evaluation/track_identity.h"
#include "uav/tracker/cue.h"
#include "uav/tracker/target_tracker.h"

namespace alidade {
namespace {

constexpr double kLeads_s[] = {0.1, 0.2, 0.5, 1.0};
constexpr double kFound_m = 4.2;

// A way of moving, which the tracker's noise matches.
struct Flight {
  const char* name;
  double agility_m2_s3;
};

struct CueTally {
  ErrorConsistencyTally consistency;
  int within_95 = 0, count = 0;
  double square_rad2 = 0.0;  // of the angle between cue and target
};

TargetSceneOptions scene_of(const Flight& flight, unsigned seed) {
  TargetSceneOptions scene;
  scene.periods = 11;
  scene.detection_probability = 0.95;
  scene.false_bearings = 0.5;
  scene.agility_m2_s3 = flight.agility_m2_s3;
  scene.seed = seed;
  return scene;
}

// Where the receiver that looks last will see the target, from the tracks at the end of a period.
void add_cue(const Receiver& receiver, const TargetPath& path, const TargetEstimate& estimate, double lead_s,
             const TargetMotion& motion, CueTally& tally) {
  const Timestamp time = estimate.state.time + from_seconds(lead_s);
  const auto cue = cue_at(receiver, estimate.state, time, motion);
  const auto truth = reading_of(receiver, position_at(path, time), time);
  if (!cue || !truth) return;
  const Eigen::Vector2d off = truth->value - cue->azimuth_elevation;
  const double nees = off.dot(cue->covariance.ldlt().solve(off));
  constexpr double k95 = 5.991;  // χ² of 2 degrees
  tally.consistency.add(nees, 2);
  tally.within_95 += nees <= k95;
  ++tally.count;
  const double angle =
      std::acos(std::min(1.0, direction_of_angles(truth->value).dot(direction_of_angles(cue->azimuth_elevation))));
  tally.square_rad2 += angle * angle;
}

// The tracks of one run after ten periods: one cue per target and lead, so that no two share an error.
void run_once(const Flight& flight, unsigned seed, std::vector<CueTally>& tallies, std::mutex& mutex) {
  const TargetScene scene = make_target_scene(scene_of(flight, seed));
  TargetTrackerOptions options;
  options.detection_probability = 0.95;
  options.filter.motion.acceleration_density = flight.agility_m2_s3;
  TargetTracker tracker(options);
  const Timestamp told = Timestamp(from_seconds(9.2));
  for (const Bearing& bearing : bearings_of(scene.receivers, scene.readings)) {
    if (bearing.time <= told) tracker.add(bearing);
  }
  auto estimates = tracker.estimates_at(told);
  std::erase_if(estimates, [](const TargetEstimate& e) { return e.status == TargetStatus::Tentative; });
  TargetMoment moment{told, {}, {}};
  for (const TargetPath& path : scene.paths) moment.truth.push_back({path.target, position_at(path, told)});
  for (const TargetEstimate& e : estimates) moment.estimates.push_back({e.id, e.state.p_world});
  const auto estimate_of = pair_by_place(moment, kFound_m);
  const std::scoped_lock lock(mutex);
  for (std::size_t k = 0; k < scene.paths.size(); ++k) {
    if (!estimate_of[k]) continue;
    for (std::size_t i = 0; i < tallies.size(); ++i) {
      add_cue(scene.receivers.back(), scene.paths[k], estimates[*estimate_of[k]], kLeads_s[i], options.filter.motion,
              tallies[i]);
    }
  }
}

}  // namespace

ExperimentSection targets_cue(const ExperimentContext& context) {
  ExperimentSection section{
      "cue",
      "Where a receiver that has to turn will see the target",
      {"Two targets, detection 0.95, half a false bearing per scan; cues for the last receiver from the tracks of ten "
       "periods. Each target and run gives one cue per lead time. Gusts: white acceleration, of which the tracker is "
       "told the density."},
      {},
      {},
      {}};
  ReportTable table{"Predicted direction against its covariance",
                    {"flight", "lead (s)", "cues", "chi2 per degree (95 % bounds)", "within 95 %", "RMS (mrad)"},
                    {}};
  for (const Flight& flight :
       {Flight{"straight", 0.0}, Flight{"gusts of 0.1 m2/s3", 0.1}, Flight{"gusts of 1 m2/s3", 1.0}}) {
    std::vector<CueTally> tallies(std::size(kLeads_s));
    std::mutex mutex;
    tbb::parallel_for(0, context.runs, [&](int run) {
      if (context.stop.stop_requested()) return;
      run_once(flight, context.seed * 1'000'003u + static_cast<unsigned>(run), tallies, mutex);
    });
    if (context.stop.stop_requested()) return section;
    if (context.progress) context.progress({fmt::format("cue, {}", flight.name), context.runs, context.runs, ""});
    for (std::size_t i = 0; i < tallies.size(); ++i) {
      const CueTally& t = tallies[i];
      const ErrorConsistency c = t.consistency.result();
      const double within = static_cast<double>(t.within_95) / std::max(1, t.count);
      const double rms_mrad = 1e3 * std::sqrt(t.square_rad2 / std::max(1, t.count));
      section.summary[flight.name][fmt::format("{}", kLeads_s[i])] = {
          {"cues", t.count},     {"chi2_per_degree", c.mean_per_degree},
          {"lower", c.lower},    {"upper", c.upper},
          {"within_95", within}, {"rms_mrad", rms_mrad}};
      table.rows.push_back({flight.name, fmt::format("{}", kLeads_s[i]), std::to_string(t.count),
                            fmt::format("{:.3f} ({:.3f} to {:.3f})", c.mean_per_degree, c.lower, c.upper),
                            fmt::format("{:.1f} %", 100.0 * within), fmt::format("{:.3f}", rms_mrad)});
    }
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace alidade
