// SPDX-License-Identifier: Apache-2.0
#include "uav/window/window_settlement.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "estimation/assignment.h"

namespace alidade {
namespace {

constexpr int kRounds = 10;  // two or three are usual
constexpr double kImpossible = -std::numeric_limits<double>::infinity();

struct Candidate {
  std::size_t track, place;  // the bearing's place in its scan
  double gain;
};

// All bearings of a scan that may be of a track.
std::vector<Candidate> candidates_in(const BearingWindow& window, const std::vector<WindowTrack>& tracks,
                                     const WindowScan& scan) {
  std::vector<Candidate> candidates;
  const double log_miss = std::log1p(-window.options.detection_probability);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (std::size_t place = 0; place < scan.bearings.size(); ++place) {
      const std::size_t bearing = scan.bearings[place];
      const double chi2 = innovation_chi2(window, bearing, tracks[i].motion);
      if (chi2 > window.options.gate_chi2) continue;
      candidates.push_back({i, place, window.log_gain[bearing] - log_miss - 0.5 * chi2});
    }
  }
  return candidates;
}

// Tracks that want the same bearings, by union-find: most clusters are of one track and one bearing.
std::vector<std::size_t> clusters_of(const std::vector<Candidate>& candidates, std::size_t tracks, std::size_t places) {
  std::vector<std::size_t> parent(tracks + places);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const Candidate& candidate : candidates) parent[root(candidate.track)] = root(tracks + candidate.place);
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root(i);
  return parent;
}

std::size_t place_among(std::vector<std::size_t>& known, std::size_t value) {
  const auto found = std::find(known.begin(), known.end(), value);
  if (found == known.end()) known.push_back(value);
  return static_cast<std::size_t>(found - known.begin());
}

void assign_cluster(std::span<const Candidate> cluster, const WindowScan& scan, std::size_t s,
                    std::vector<WindowTrack>& tracks) {
  if (cluster.size() == 1) {
    if (cluster[0].gain > 0.0) tracks[cluster[0].track].bearing_of_scan[s] = scan.bearings[cluster[0].place];
    return;
  }
  std::vector<std::size_t> rows, columns;
  for (const Candidate& c : cluster) {
    place_among(rows, c.track);
    place_among(columns, c.place);
  }
  Eigen::MatrixXd gain = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(rows.size()),
                                                   static_cast<Eigen::Index>(columns.size()), kImpossible);
  for (const Candidate& c : cluster) {
    gain(static_cast<Eigen::Index>(place_among(rows, c.track)),
         static_cast<Eigen::Index>(place_among(columns, c.place))) = c.gain;
  }
  const auto chosen = best_assignment(gain);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (chosen[i]) tracks[rows[i]].bearing_of_scan[s] = scan.bearings[columns[static_cast<std::size_t>(*chosen[i])]];
  }
}

void assign_scan(const BearingWindow& window, std::size_t s, std::vector<WindowTrack>& tracks) {
  const WindowScan& scan = window.scans[s];
  for (WindowTrack& track : tracks) track.bearing_of_scan[s] = kNoBearing;
  std::vector<Candidate> candidates = candidates_in(window, tracks, scan);
  const auto cluster_of = clusters_of(candidates, tracks.size(), scan.bearings.size());
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](const Candidate& a, const Candidate& b) { return cluster_of[a.track] < cluster_of[b.track]; });
  for (std::size_t begin = 0; begin < candidates.size();) {
    std::size_t end = begin;
    while (end < candidates.size() && cluster_of[candidates[end].track] == cluster_of[candidates[begin].track]) ++end;
    assign_cluster(std::span(candidates).subspan(begin, end - begin), scan, s, tracks);
    begin = end;
  }
}

using Assignment = std::vector<std::vector<std::size_t>>;

Assignment assignment_of(const std::vector<WindowTrack>& tracks) {
  Assignment assignment;
  for (const WindowTrack& track : tracks) assignment.push_back(track.bearing_of_scan);
  return assignment;
}

// Bearings among tracks and motions in turns. Tracks without a motion go.
void share_out(const BearingWindow& window, std::vector<WindowTrack>& tracks) {
  for (int round = 0; round < kRounds; ++round) {
    const Assignment before = assignment_of(tracks);
    for (std::size_t s = 0; s < window.scans.size(); ++s) assign_scan(window, s, tracks);
    if (round > 0 && assignment_of(tracks) == before) return;
    std::erase_if(tracks, [&](WindowTrack& track) { return !refit(window, track); });
  }
}

}  // namespace

std::vector<WindowTrack> settle_tracks(const BearingWindow& window, std::vector<WindowTrack> tracks) {
  share_out(window, tracks);
  while (!tracks.empty()) {
    const auto least = std::min_element(tracks.begin(), tracks.end(), [](const WindowTrack& a, const WindowTrack& b) {
      return a.log_ratio < b.log_ratio;
    });
    if (least->log_ratio >= window.options.least_log_ratio) break;
    tracks.erase(least);
    share_out(window, tracks);
  }
  return tracks;
}

}  // namespace alidade
