// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <random>

#include <Eigen/Cholesky>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "app/experiments/body_experiment.h"
#include "app/experiments/cpu_clock.h"
#include "datasets/body_scene.h"
#include "estimation/line_bound.h"
#include "geometry/plane_pose_minima.h"
#include "marker1d/body_start.h"

namespace alidade {
namespace {

constexpr double kSigma_rad = 1e-4;
constexpr double kFullInformation_m = 0.005;  // the bound of a frame that tells the pose
constexpr double kFarthest = 60.0;            // χ² of six degrees of freedom: beyond it, once in 2e10

// One moment of a body anywhere in the room, in any attitude.
struct Moment {
  Eigen::Isometry3d truth;
  std::vector<LineReading> readings, exact;
};

class Room {
 public:
  explicit Room(int markers) : scene_(options_for(markers)), array_(scene_.detectors()) {}

  const DetectorArray& array() const { return array_; }
  const std::vector<LineDetector>& detectors() const { return scene_.detectors(); }
  const RigidBody& body() const { return scene_.bodies().front(); }

  Eigen::Isometry3d any_pose(std::mt19937_64& random) const {
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::normal_distribution<double> normal;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Eigen::Vector3d(0.5 * uniform(random), 0.5 * uniform(random), 1 + 0.3 * uniform(random));
    const Eigen::Vector4d q(normal(random), normal(random), normal(random), normal(random));
    T.linear() = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
    return T;
  }

  void read(std::size_t detector, std::size_t marker, std::mt19937_64& random, Moment& moment) const {
    const LineDetector& d = detectors()[detector];
    const BodyMarker& m = body().markers[marker];
    const auto seen = project(d, moment.truth * m.p_body);
    if (!seen) return;
    moment.exact.push_back({Timestamp{}, d.id, m.id, seen->value, kSigma_rad});
    moment.readings.push_back(moment.exact.back());
    moment.readings.back().value += kSigma_rad * std::normal_distribution<double>()(random);
  }

 private:
  static BodySceneOptions options_for(int markers) {
    BodySceneOptions options;
    options.markers = markers;
    return options;
  }

  BodyScene scene_;
  DetectorArray array_;
};

// Any share of all readings, of which a share names another marker; drawn until the right ones tell the pose.
Moment any_moment(const Room& room, double wrong_ids, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform;
  const std::size_t markers = room.body().markers.size();
  for (;;) {
    Moment moment{room.any_pose(random), {}, {}};
    const double share = 0.15 + 0.85 * uniform(random);
    std::vector<LineReading> right;
    for (std::size_t m = 0; m < markers; ++m) {
      for (std::size_t d = 0; d < room.detectors().size(); ++d) {
        if (uniform(random) > share) continue;
        room.read(d, m, random, moment);
        if (uniform(random) >= wrong_ids) {
          right.push_back(moment.readings.back());
        } else {
          const auto other = (m + 1 + static_cast<std::size_t>(uniform(random) * static_cast<double>(markers - 1)));
          moment.readings.back().marker = room.body().markers[other % markers].id;
        }
      }
    }
    const auto bound = pose_bound(pose_information(room.detectors(), room.body(), moment.truth, right));
    if (bound && bound->position_m2 < kFullInformation_m * kFullInformation_m) return moment;
  }
}

// So many planes of each marker, of detectors drawn at random; until they tell the pose.
Moment few_planes(const Room& room, const std::vector<int>& planes, std::mt19937_64& random) {
  std::vector<std::size_t> order(room.detectors().size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  for (;;) {
    Moment moment{room.any_pose(random), {}, {}};
    for (std::size_t m = 0; m < planes.size(); ++m) {
      std::shuffle(order.begin(), order.end(), random);
      for (int i = 0; i < planes[m]; ++i) room.read(order[static_cast<std::size_t>(i)], m, random, moment);
    }
    const auto bound = pose_bound(pose_information(room.detectors(), room.body(), moment.truth, moment.readings));
    if (bound && bound->position_m2 < kFullInformation_m * kFullInformation_m) return moment;
  }
}

bool is_right(const BodyCandidate& candidate, const Eigen::Isometry3d& truth) {
  const Vector6d error = difference(candidate.state.T_world_body, truth);
  const Matrix6d P = candidate.state.covariance.topLeftCorner<6, 6>();
  return error.dot(P.llt().solve(error)) < kFarthest;
}

int exact_solutions(const Room& room, const Moment& moment) {
  std::vector<PlaneConstraint> constraints;
  for (const LineReading& r : moment.exact) {
    const auto marker = std::find_if(room.body().markers.begin(), room.body().markers.end(),
                                     [&](const BodyMarker& m) { return m.id == r.marker; });
    constraints.push_back({marker->p_body, *plane_of(room.array().at(r.detector).detector, r.value), 1.0});
  }
  int count = 0;
  for (const PlanePose& minimum : all_minima(constraints)) count += minimum.chi2 < 1e-16;  // 10 nm
  return count;
}

struct StartTally {
  int trials = 0, none = 0, certain_right = 0, certain_wrong = 0, ambiguous_with_truth = 0, ambiguous_without = 0;
  double seconds = 0;
  std::array<int, 9> solutions{};  // trials with so many exact poses; the last: so many or more

  int certain() const { return certain_right + certain_wrong; }
  int ambiguous() const { return ambiguous_with_truth + ambiguous_without; }
  double truth_among() const {
    return (certain_right + ambiguous_with_truth) / static_cast<double>(std::max(1, trials - none));
  }
};

void add(StartTally& tally, const std::vector<BodyCandidate>& candidates, const Eigen::Isometry3d& truth) {
  ++tally.trials;
  const bool holds_truth =
      std::any_of(candidates.begin(), candidates.end(), [&](const BodyCandidate& c) { return is_right(c, truth); });
  if (candidates.empty()) {
    ++tally.none;
  } else if (candidates.size() == 1) {
    ++(holds_truth ? tally.certain_right : tally.certain_wrong);
  } else {
    ++(holds_truth ? tally.ambiguous_with_truth : tally.ambiguous_without);
  }
}

struct StartCondition {
  std::string name;
  int markers;
  double wrong_ids;
  std::vector<int> planes;  // of each marker; empty: any share of all
};

StartTally try_starts(const StartCondition& condition, const ExperimentContext& context) {
  const Room room(condition.markers);
  StartTally tally;
  std::mutex mutex;
  tbb::parallel_for(0, context.runs, [&](int trial) {
    if (context.stop.stop_requested()) return;
    std::mt19937_64 random(context.seed * 1'000'003ull + static_cast<unsigned>(trial));
    const Moment moment = condition.planes.empty() ? any_moment(room, condition.wrong_ids, random)
                                                   : few_planes(room, condition.planes, random);
    const double begin = thread_seconds();
    const auto candidates = start_body(room.array(), room.body(), moment.readings, Timestamp{}, 1.0);
    const double seconds = thread_seconds() - begin;
    const int solutions = condition.planes.empty() ? 0 : exact_solutions(room, moment);
    const std::scoped_lock lock(mutex);
    add(tally, candidates, moment.truth);
    tally.seconds += seconds;
    ++tally.solutions[std::min<std::size_t>(static_cast<std::size_t>(solutions), tally.solutions.size() - 1)];
    if (context.progress && tally.trials % 200 == 0) {
      context.progress({"start, " + condition.name, tally.trials, context.runs, ""});
    }
  });
  return tally;
}

nlohmann::json summary_of(const StartTally& t) {
  return {{"trials", t.trials},
          {"none", t.none},
          {"certain", t.certain()},
          {"certain_wrong", t.certain_wrong},
          {"ambiguous", t.ambiguous()},
          {"ambiguous_without_truth", t.ambiguous_without},
          {"truth_among", t.truth_among()},
          {"cpu_ms", 1e3 * t.seconds / t.trials},
          {"exact_solutions", t.solutions}};
}

}  // namespace

ExperimentSection body_start(const ExperimentContext& context) {
  ExperimentSection section{
      "start",
      "The pose without a prior",
      {"Anywhere in the room and in any attitude, of readings that tell the pose to 5 mm. Certain: one pose is left. "
       "Wrong: off by more than chi2 60 of its six degrees of freedom."},
      {},
      {},
      {}};
  const std::vector<StartCondition> conditions{{"any readings, 4 markers", 4, 0.0, {}},
                                               {"any readings, 3 markers", 3, 0.0, {}},
                                               {"20 % wrong ids", 4, 0.2, {}},
                                               {"30 % wrong ids", 4, 0.3, {}},
                                               {"2+2+2", 3, 0.0, {2, 2, 2}},
                                               {"1+2+3", 3, 0.0, {1, 2, 3}},
                                               {"3+2+2", 3, 0.0, {3, 2, 2}},
                                               {"3+3+2", 3, 0.0, {3, 3, 2}},
                                               {"3+3+3", 3, 0.0, {3, 3, 3}},
                                               {"4+4+4", 3, 0.0, {4, 4, 4}}};
  ReportTable table{
      "Starts", {"readings", "certain", "of them wrong", "ambiguous", "without the truth", "no answer", "ms each"}, {}};
  ReportTable solutions{"Poses that fit exact planes", {"planes", "1", "2", "3", "4", "5", "6", "7", "8 or more"}, {}};
  for (const StartCondition& condition : conditions) {
    const StartTally t = try_starts(condition, context);
    if (context.stop.stop_requested()) return section;
    section.summary[condition.name] = summary_of(t);
    table.rows.push_back({condition.name, std::to_string(t.certain()), std::to_string(t.certain_wrong),
                          std::to_string(t.ambiguous()), std::to_string(t.ambiguous_without), std::to_string(t.none),
                          fmt::format("{:.3f}", 1e3 * t.seconds / t.trials)});
    if (condition.planes.empty()) continue;
    solutions.rows.push_back({condition.name});
    for (std::size_t i = 1; i < t.solutions.size(); ++i) {
      solutions.rows.back().push_back(fmt::format("{:.2f} %", 100.0 * t.solutions[i] / t.trials));
    }
  }
  section.tables.push_back(std::move(table));
  section.tables.push_back(std::move(solutions));
  return section;
}

}  // namespace alidade
