// SPDX-License-Identifier: Apache-2.0
#include "evaluation/association.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

namespace alidade {
namespace {

// evo keeps times as doubles, whose rounding (0.2 µs at the size of Unix times) decides between two poses that are
// equally near. We compare in the same doubles, so that the same pairs come out; parsed from nanoseconds by way of long
// double they are the ones nearest to the decimals in the file.
std::vector<double> seconds_of(const Trajectory& trajectory, double offset_s) {
  std::vector<double> seconds;
  for (const StampedPose& pose : trajectory) {
    const long double exact = static_cast<long double>(pose.time.time_since_epoch().count()) / 1e9L;
    seconds.push_back(static_cast<double>(exact) + offset_s);
  }
  return seconds;
}

struct Neighbour {
  std::size_t index = 0;
  double apart_s = 0;
};

// The time nearest to `time`; of two equally near the earlier.
std::optional<Neighbour> nearest(const std::vector<double>& times, double time) {
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  const auto index = static_cast<std::size_t>(after - times.begin());
  std::optional<Neighbour> best;
  if (index > 0) best = Neighbour{index - 1, time - times[index - 1]};
  if (index < times.size() && (!best || times[index] - time < best->apart_s)) {
    best = Neighbour{index, times[index] - time};
  }
  return best;
}

struct Match {
  std::size_t shorter = 0;
  Neighbour longer;
};

// In order of time the claims on one pose follow each other: the last one kept is compared with the next.
std::vector<Match> match(const std::vector<double>& shorter, const std::vector<double>& longer, double longest_s) {
  std::vector<Match> matches;
  for (std::size_t i = 0; i < shorter.size(); ++i) {
    const auto found = nearest(longer, shorter[i]);
    if (!found || found->apart_s > longest_s) continue;
    if (matches.empty() || matches.back().longer.index != found->index) {
      matches.push_back({i, *found});
    } else if (found->apart_s < matches.back().longer.apart_s) {
      matches.back() = {i, *found};
    }
  }
  return matches;
}

}  // namespace

PairedTrajectories associate_by_time(const Trajectory& estimate, const Trajectory& truth,
                                     const AssociationOptions& options) {
  const bool truth_is_shorter = truth.size() < estimate.size();
  const Trajectory& shorter = truth_is_shorter ? truth : estimate;
  const Trajectory& longer = truth_is_shorter ? estimate : truth;
  const double offset_s = truth_is_shorter ? options.time_offset_s : -options.time_offset_s;
  PairedTrajectories pairs;
  for (const Match& m : match(seconds_of(shorter, 0.0), seconds_of(longer, offset_s), options.max_time_difference_s)) {
    pairs.estimate.push_back(estimate[truth_is_shorter ? m.longer.index : m.shorter]);
    pairs.truth.push_back(truth[truth_is_shorter ? m.shorter : m.longer.index]);
  }
  return pairs;
}

double shortest_time_apart_s(const Trajectory& estimate, const Trajectory& truth, double time_offset_s) {
  const std::vector<double> times = seconds_of(truth, 0.0);
  double shortest_s = std::numeric_limits<double>::infinity();
  for (double time : seconds_of(estimate, time_offset_s)) {
    if (const auto found = nearest(times, time)) shortest_s = std::min(shortest_s, found->apart_s);
  }
  return shortest_s;
}

}  // namespace alidade
