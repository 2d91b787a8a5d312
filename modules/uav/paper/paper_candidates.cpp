// SPDX-License-Identifier: Apache-2.0
#include "uav/paper/paper_candidates.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace alidade {
namespace {

using Choices = std::vector<std::vector<std::size_t>>;  // by receiver: its bearings of one period

std::int64_t period_of(Timestamp time, double period_s) {
  const std::int64_t t = time.time_since_epoch().count(), period = from_seconds(period_s).count();
  return t / period - (t % period < 0 ? 1 : 0);
}

// Finds the candidates of one period: bearings are chosen receiver by receiver, and a choice is given up as soon as two
// of its lines pass too far from each other.
class Chooser {
 public:
  Chooser(std::span<const Bearing> bearings, const Choices& choices, const PaperOptions& options)
      : bearings_(bearings), choices_(choices), options_(options) {}

  std::vector<PaperCandidate> choose() {
    extend();
    return std::move(candidates_);
  }

 private:
  void extend() {
    if (chosen_.size() == choices_.size()) return add();
    for (const std::size_t next : choices_[chosen_.size()]) {
      const bool meets = std::all_of(chosen_.begin(), chosen_.end(), [&](std::size_t other) {
        const auto pair = solve_pair(bearings_[other], bearings_[next]);
        const double threshold_m = options_.pair_threshold_m;
        return !pair || pair->residual_m2 <= threshold_m * threshold_m;  // parallel lines may be joined by others
      });
      if (!meets) continue;
      chosen_.push_back(next);
      extend();
      chosen_.pop_back();
    }
  }

  void add() {
    PaperCandidate candidate{{}, 0.0, chosen_};
    std::vector<Bearing> chosen;
    for (const std::size_t i : chosen_) chosen.push_back(bearings_[i]);
    if (!(options_.method == PaperMethod::Alternative ? meet_at_once(chosen, candidate) : meet(chosen, candidate))) {
      return;
    }
    candidates_.push_back(std::move(candidate));
  }

  static bool meet_at_once(const std::vector<Bearing>& pair, PaperCandidate& candidate) {
    const auto fix = solve_pair(pair[0], pair[1]);
    if (!fix || fix->r1_m <= 0.0 || fix->r2_m <= 0.0) return false;
    candidate.state.time = pair[0].time;
    candidate.state.p_world = fix->p_world;
    candidate.state.covariance.topLeftCorner<3, 3>() = fix->covariance_world;
    candidate.residual_m2 = fix->residual_m2;
    return true;
  }

  bool meet(const std::vector<Bearing>& chosen, PaperCandidate& candidate) const {
    const bool has_enough = chosen.size() >= static_cast<std::size_t>(least_bearings(options_.motion));
    const auto fix = solve_in_two_steps(chosen, has_enough ? options_.motion : PaperMotion::Velocity);
    if (!fix || std::any_of(fix->ranges_m.begin(), fix->ranges_m.end(), [](double r) { return r <= 0.0; })) {
      return false;
    }
    candidate.state = fix->state;
    candidate.residual_m2 = fix->residual_m2;
    return true;
  }

  std::span<const Bearing> bearings_;
  const Choices& choices_;
  const PaperOptions& options_;
  std::vector<std::size_t> chosen_;
  std::vector<PaperCandidate> candidates_;
};

std::set<int> receivers_of(std::span<const Bearing> bearings) {
  std::set<int> receivers;
  for (const Bearing& bearing : bearings) receivers.insert(bearing.receiver);
  return receivers;
}

}  // namespace

std::vector<PaperPeriod> paper_candidates(std::span<const Bearing> bearings, const PaperOptions& options) {
  validate(options);
  const bool is_alternative = options.method == PaperMethod::Alternative;
  const std::size_t fewest = is_alternative ? 2 : 3;
  std::set<int> receivers = receivers_of(bearings);
  if (receivers.size() < fewest) return {};
  if (is_alternative) receivers.erase(std::next(receivers.begin(), 2), receivers.end());

  std::map<std::int64_t, std::map<int, std::vector<std::size_t>>> seen;
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    auto& of_period = seen[period_of(bearings[i].time, options.period_s)];
    if (receivers.contains(bearings[i].receiver)) of_period[bearings[i].receiver].push_back(i);
  }
  std::vector<PaperPeriod> periods;
  for (const auto& [index, by_receiver] : seen) {
    while (!periods.empty() && periods.back().index + 1 < index) periods.push_back({periods.back().index + 1, {}});
    Choices choices;
    for (const auto& [receiver, indices] : by_receiver) choices.push_back(indices);
    periods.push_back({index, {}});
    if (choices.size() >= fewest) periods.back().candidates = Chooser(bearings, choices, options).choose();
  }
  return periods;
}

}  // namespace alidade
