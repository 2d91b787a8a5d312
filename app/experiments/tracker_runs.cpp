// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/tracker_runs.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <mutex>
#include <random>
#include <tuple>

#include <Eigen/Cholesky>
#include <tbb/parallel_for.h>

#include "app/experiments/cpu_clock.h"
#include "datasets/scan_law.h"
#include "evaluation/gospa.h"
#include "evaluation/track_identity.h"
#include "uav/tracker/known_target.h"

namespace alidade {
namespace {

constexpr double kFound_m = 4.2;  // the paper page's: nearer than this, a target is found
constexpr SetMetricOptions kMetric{kFound_m, 2.0};

// What one run gives.
struct Run {
  TrackIdentity identity;
  std::vector<Gospa> gospa;
  std::vector<double> ospa_m;
  double square_m2 = 0.0;
  int errors = 0;
  double shared_m2 = 0.0, known_m2 = 0.0, bound_m2 = 0.0;  // sums over what both filters answer
  int shared = 0;
  std::vector<double> nees;  // of the last moment
  double moved_m = 0.0;
  double seconds = 0.0;
  std::size_t bearings = 0;
};

std::vector<Bearing> in_order_of_arrival(std::vector<Bearing> bearings, double shuffled_s, unsigned seed) {
  if (shuffled_s <= 0.0) return bearings;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> delay(0.0, shuffled_s);
  std::vector<std::pair<double, Bearing>> arrivals;
  for (const Bearing& b : bearings) {
    arrivals.emplace_back(to_seconds(b.time.time_since_epoch()) + delay(random), b);
  }
  std::sort(arrivals.begin(), arrivals.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < bearings.size(); ++i) bearings[i] = arrivals[i].second;
  return bearings;
}

// The moments to answer for: of each period, when the last receiver has looked.
std::vector<Timestamp> moments_of(const TargetSceneOptions& options) {
  std::vector<Timestamp> moments;
  for (int period = 0; period < options.periods; ++period) {
    const auto ends = scan_ends(options, Timestamp(from_seconds(period * options.period_s)));
    moments.push_back(*std::max_element(ends.begin(), ends.end()));
  }
  return moments;
}

struct Answers {
  Timestamp time{};
  std::vector<TargetEstimate> estimates;
};

std::vector<Answers> track(const TrackerCell& cell, const std::vector<Bearing>& arrivals,
                           const std::vector<Timestamp>& moments) {
  TargetTracker tracker(cell.tracker);
  std::vector<Answers> answers;
  const auto wait = from_seconds(cell.shuffled_s);
  std::size_t next = 0;
  const auto answer_until = [&](Timestamp time) {
    for (; next < moments.size() && moments[next] + wait < time; ++next) {
      answers.push_back({moments[next], tracker.estimates_at(moments[next])});
    }
  };
  for (const Bearing& bearing : arrivals) {
    answer_until(std::max(tracker.now(), bearing.time));
    tracker.add(bearing);
  }
  answer_until(Timestamp::max());
  for (Answers& a : answers) {
    std::erase_if(a.estimates, [](const TargetEstimate& e) { return e.status == TargetStatus::Tentative; });
  }
  return answers;
}

// What there is to compare with, of one target at one moment.
struct Reference {
  std::optional<TargetState> known, bound;
};

void add_error(const TargetPath& path, const TargetEstimate& estimate, const Reference& reference, Run& run) {
  const Timestamp time = estimate.state.time;
  Vector6d error;
  error << estimate.state.p_world - position_at(path, time), estimate.state.v_world - velocity_at(path, time);
  const double square = error.head<3>().squaredNorm();
  run.square_m2 += square;
  ++run.errors;
  run.nees.push_back(error.dot(estimate.state.covariance.topLeftCorner<6, 6>().ldlt().solve(error)));
  if (!reference.known) return;
  run.shared_m2 += square;
  run.known_m2 += (reference.known->p_world - position_at(path, time)).squaredNorm();
  run.bound_m2 += reference.bound->covariance.topLeftCorner<3, 3>().trace();
  ++run.shared;
}

void add_moment(const TargetScene& scene, const Answers& answers, const std::vector<Reference>& references, Run& run,
                std::vector<TargetMoment>& moments) {
  TargetMoment moment{answers.time, {}, {}};
  std::vector<Eigen::Vector3d> truth, estimates;
  for (const TargetPath& path : scene.paths) {
    if (answers.time < path.birth || answers.time >= path.death) continue;
    truth.push_back(position_at(path, answers.time));
    moment.truth.push_back({path.target, truth.back()});
  }
  for (const TargetEstimate& e : answers.estimates) {
    estimates.push_back(e.state.p_world);
    moment.estimates.push_back({e.id, e.state.p_world});
  }
  run.gospa.push_back(gospa(truth, estimates, kMetric));
  run.ospa_m.push_back(ospa(truth, estimates, kMetric));
  run.nees.clear();
  const auto estimate_of = pair_by_place(moment, kFound_m);
  for (std::size_t i = 0; i < estimate_of.size(); ++i) {
    if (!estimate_of[i]) continue;
    const auto target = static_cast<std::size_t>(moment.truth[i].id);
    add_error(scene.paths[target], answers.estimates[*estimate_of[i]], references[target], run);
  }
  moments.push_back(std::move(moment));
}

TargetState true_state(const TargetPath& path, Timestamp time) {
  TargetState state;
  state.time = time;
  state.p_world = position_at(path, time);
  state.v_world = velocity_at(path, time);
  return state;
}

// Of each moment, by target.
std::vector<std::vector<Reference>> references_of(const TargetScene& scene, const std::vector<Bearing>& bearings,
                                                  const std::vector<Timestamp>& times,
                                                  const TargetTrackerOptions& options) {
  std::vector<std::vector<Reference>> references(times.size(), std::vector<Reference>(scene.paths.size()));
  for (const TargetPath& path : scene.paths) {
    std::vector<Bearing> of_it;
    std::copy_if(bearings.begin(), bearings.end(), std::back_inserter(of_it),
                 [&](const Bearing& b) { return b.target == path.target; });
    const auto known = follow_known_target(of_it, times, options);
    const auto bound = tracking_bound(
        of_it, times, [&](Timestamp time) { return true_state(path, time); }, options);
    for (std::size_t i = 0; i < times.size(); ++i) {
      references[i][static_cast<std::size_t>(path.target)] = {known[i], bound[i]};
    }
  }
  return references;
}

// Infinite where there are others than before.
double farthest(const std::vector<Answers>& a, const std::vector<Answers>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].estimates.size() != b[i].estimates.size()) return std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < a[i].estimates.size(); ++k) {
      const TargetEstimate &one = a[i].estimates[k], &other = b[i].estimates[k];
      if (one.id != other.id) return std::numeric_limits<double>::infinity();
      most = std::max(most, (one.state.p_world - other.state.p_world).norm());
    }
  }
  return most;
}

Run run_once(const TrackerCell& cell, unsigned seed) {
  TargetSceneOptions options = cell.scene;
  options.seed = seed;
  const TargetScene scene = make_target_scene(options);
  const std::vector<Bearing> bearings = bearings_of(scene.receivers, scene.readings);
  const std::vector<Bearing> arrivals = in_order_of_arrival(bearings, cell.shuffled_s, seed);
  const std::vector<Timestamp> times = moments_of(options);
  Run run;
  run.bearings = bearings.size();
  const double begin = thread_seconds();
  const std::vector<Answers> answers = track(cell, arrivals, times);
  run.seconds = thread_seconds() - begin;
  if (cell.shuffled_s > 0.0) run.moved_m = farthest(answers, track(cell, bearings, times));
  const auto references = references_of(scene, bearings, times, cell.tracker);
  std::vector<TargetMoment> moments;
  for (std::size_t i = 0; i < times.size(); ++i) add_moment(scene, answers[i], references[i], run, moments);
  run.identity = track_identity(moments, kFound_m);
  return run;
}

// Of values in any order: what 99 % do not exceed, and the greatest.
std::pair<double, double> most_of(std::vector<double> values) {
  if (values.empty()) return {0.0, 0.0};
  std::sort(values.begin(), values.end());
  const auto place = static_cast<std::size_t>(std::ceil(0.99 * static_cast<double>(values.size()))) - 1;
  return {values[place], values.back()};
}

void add_delays(const std::vector<Run>& runs, const TargetSceneOptions& scene, TrackerScore& score) {
  std::vector<double> found, given_up;
  for (const Run& run : runs) {
    for (const TargetHistory& target : run.identity.targets) {
      found.push_back(target.found_s ? *target.found_s / scene.period_s : scene.periods);
      if (target.outlived_s) given_up.push_back(*target.outlived_s / scene.period_s);
    }
  }
  std::tie(score.found_99, score.found_worst) = most_of(std::move(found));
  std::tie(score.given_up_99, score.given_up_worst) = most_of(std::move(given_up));
}

// Means over runs and periods.
void add_set_metrics(const std::vector<Run>& runs, TrackerScore& score) {
  int moments = 0;
  for (const Run& run : runs) {
    double sum = 0.0;
    for (const Gospa& g : run.gospa) {
      score.localisation_m2 += g.localisation;
      score.missed_m2 += g.missed_cost;
      score.false_m2 += g.false_cost;
      sum += g.total_m * g.total_m;
      ++moments;
    }
    score.gospa_m2.push_back(sum / static_cast<double>(run.gospa.size()));
    for (const double d : run.ospa_m) score.ospa_m += d;
  }
  for (double* mean : {&score.localisation_m2, &score.missed_m2, &score.false_m2, &score.ospa_m}) *mean /= moments;
  score.gospa_m = pooled_rms(score.gospa_m2);
}

void add_errors(const std::vector<Run>& runs, TrackerScore& score) {
  std::vector<double> own, known, bound;
  ErrorConsistencyTally nees;
  double squares = 0.0;
  int errors = 0;
  for (const Run& run : runs) {
    own.push_back(run.shared_m2);
    known.push_back(run.known_m2);
    bound.push_back(run.bound_m2);
    for (const double e : run.nees) nees.add(e, 6);
    squares += run.square_m2;
    errors += run.errors;
  }
  score.rms_m = std::sqrt(squares / std::max(1, errors));
  score.to_true_association = ratio_of_rms(own, known);
  score.to_bound = ratio_of_rms(own, bound);
  score.nees = nees.result();
}

TrackerScore score_of(const std::vector<Run>& runs, const TargetSceneOptions& scene) {
  TrackerScore score;
  score.runs = static_cast<int>(runs.size());
  double seconds = 0.0;
  std::size_t bearings = 0;
  for (const Run& run : runs) {
    score.switches_per_run += static_cast<double>(run.identity.switches) / score.runs;
    score.false_ids_per_run += static_cast<double>(run.identity.false_ids) / score.runs;
    score.purity += run.identity.purity / score.runs;
    score.completeness += run.identity.completeness / score.runs;
    score.moved_by_shuffling_m = std::max(score.moved_by_shuffling_m, run.moved_m);
    seconds += run.seconds;
    bearings += run.bearings;
  }
  add_set_metrics(runs, score);
  add_errors(runs, score);
  add_delays(runs, scene, score);
  score.us_per_bearing = 1e6 * seconds / static_cast<double>(std::max<std::size_t>(1, bearings));
  return score;
}

}  // namespace

TrackerScore score_tracker(const TrackerCell& cell, const ExperimentContext& context) {
  std::vector<Run> runs(static_cast<std::size_t>(context.runs));
  std::mutex mutex;
  int done = 0;
  tbb::parallel_for(0, context.runs, [&](int run) {
    if (context.stop.stop_requested()) return;
    runs[static_cast<std::size_t>(run)] = run_once(cell, context.seed * 1'000'003u + static_cast<unsigned>(run));
    const std::scoped_lock lock(mutex);
    if (context.progress) context.progress({"tracker, " + cell.name, ++done, context.runs, ""});
  });
  return context.stop.stop_requested() ? TrackerScore{} : score_of(runs, cell.scene);
}

nlohmann::json summary_of(const TrackerScore& s) {
  return {{"runs", s.runs},
          {"switches_per_run", s.switches_per_run},
          {"false_ids_per_run", s.false_ids_per_run},
          {"purity", s.purity},
          {"completeness", s.completeness},
          {"gospa_m", s.gospa_m},
          {"ospa_m", s.ospa_m},
          {"localisation_m2", s.localisation_m2},
          {"missed_m2", s.missed_m2},
          {"false_m2", s.false_m2},
          {"rms_m", s.rms_m},
          {"to_true_association", s.to_true_association.value},
          {"to_bound", s.to_bound.value},
          {"nees_per_dof", s.nees.mean_per_degree},
          {"nees_lower", s.nees.lower},
          {"nees_upper", s.nees.upper},
          {"found_99_periods", s.found_99},
          {"found_worst_periods", s.found_worst},
          {"given_up_99_periods", s.given_up_99},
          {"given_up_worst_periods", s.given_up_worst},
          {"moved_by_shuffling_m", s.moved_by_shuffling_m},
          {"us_per_bearing", s.us_per_bearing}};
}

}  // namespace alidade
