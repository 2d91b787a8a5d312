// SPDX-License-Identifier: Apache-2.0
#include "app/targets/target_evaluation.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/median.h"
#include "geometry/positions.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;
using Duration = RecordingClock::duration;

constexpr double kLongestGap_s = 1.0;

std::map<int, std::vector<TimedPosition>> paths_of(std::span<const TargetRow> rows) {
  std::map<int, std::vector<TimedPosition>> paths;
  for (const TargetRow& row : rows) paths[row.target].push_back({row.time, row.p_world});
  for (auto& [target, path] : paths) {
    std::stable_sort(path.begin(), path.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  }
  return paths;
}

// The median time between successive rows of a target.
Duration usual_step(std::span<const TargetRow> rows) {
  std::vector<Duration> steps;
  for (const auto& [target, path] : paths_of(rows)) {
    for (std::size_t i = 1; i < path.size(); ++i) {
      if (path[i].time > path[i - 1].time) steps.push_back(path[i].time - path[i - 1].time);
    }
  }
  return steps.empty() ? from_seconds(kLongestGap_s) : median(std::move(steps));
}

IdentifiedPosition moved_to(const TargetRow& row, Timestamp time) {
  const double dt = to_seconds(time - row.time);
  IdentifiedPosition position{row.target, row.p_world + dt * row.v_world, {}};
  if (!row.covariance) return position;
  const Matrix6d& P = *row.covariance;
  const Eigen::Matrix3d P_pv = P.topRightCorner<3, 3>();
  position.covariance =
      P.topLeftCorner<3, 3>() + dt * (P_pv + P_pv.transpose()) + dt * dt * P.bottomRightCorner<3, 3>();
  return position;
}

// Estimates in order of time; those of different targets that are nearer than half a step are of one moment, the first
// one's.
std::vector<TargetMoment> told_moments(std::span<const TargetRow> estimates, Duration step) {
  std::vector<TargetRow> rows(estimates.begin(), estimates.end());
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  std::vector<TargetMoment> moments;
  for (const TargetRow& row : rows) {
    const auto is_same = [&](const IdentifiedPosition& other) { return other.id == row.target; };
    const bool is_new = moments.empty() || row.time - moments.back().time >= step / 2 ||
                        std::ranges::any_of(moments.back().estimates, is_same);
    if (is_new) moments.push_back({row.time, {}, {}});
    moments.back().estimates.push_back(moved_to(row, moments.back().time));
  }
  return moments;
}

// Those from `first` to `last`, and empty ones a step apart where these leave a gap.
std::vector<TargetMoment> with_gaps_filled(std::vector<TargetMoment> told, Duration step, Timestamp first,
                                           Timestamp last) {
  constexpr int kMostFilled = 100'000;
  std::erase_if(told, [&](const TargetMoment& moment) { return moment.time < first || moment.time > last; });
  step = std::max({step, (last - first) / kMostFilled, Duration(1)});
  std::vector<TargetMoment> all;
  const Timestamp begin = told.empty() ? first : first + (told.front().time - first) % step;
  const auto fill = [&](Timestamp from, Timestamp until) {
    for (Timestamp t = from; t <= until; t += step) all.push_back({t, {}, {}});
  };
  Timestamp next = begin;
  for (TargetMoment& moment : told) {
    fill(next, moment.time - step / 2 - Duration(1));
    next = moment.time + step;
    all.push_back(std::move(moment));
  }
  fill(next, last);
  return all;
}

}  // namespace

bool is_target_file(const fs::path& path) {
  std::ifstream file(target_file_of(path));
  std::string header;
  std::getline(file, header);
  return header.find("target") != std::string::npos && header.find("x_m") != std::string::npos;
}

fs::path target_file_of(const fs::path& path) {
  if (!fs::is_directory(path)) return path;
  return path / (fs::exists(path / "tracks.csv") ? "tracks.csv" : "truth.csv");
}

std::vector<TargetMoment> moments_of(std::span<const TargetRow> estimates, std::span<const TargetRow> truth) {
  Timestamp first = Timestamp::max(), last = Timestamp::min();
  for (const TargetRow& row : truth) first = std::min(first, row.time), last = std::max(last, row.time);
  const Duration step = usual_step(estimates);
  const auto paths = paths_of(truth);
  std::vector<TargetMoment> moments = with_gaps_filled(told_moments(estimates, step), step, first, last);
  for (TargetMoment& moment : moments) {
    for (const auto& [target, path] : paths) {
      const auto p = position_at(path, moment.time, from_seconds(kLongestGap_s));
      if (p) moment.truth.push_back({target, *p, {}});
    }
  }
  return moments;
}

std::vector<std::string> table_lines(const TargetScores& s) {
  return {fmt::format("moments                      {}", s.moments),
          fmt::format("GOSPA (m), mean              {:.6f}", s.gospa_m),
          fmt::format("OSPA (m), mean               {:.6f}", s.ospa_m),
          fmt::format("position error (m), RMS      {:.6f}", s.rms_m),
          fmt::format("position error (m), median   {:.6f}", s.median_m),
          fmt::format("targets seen (share)         {:.6f}", s.identity.completeness),
          fmt::format("number of targets right      {:.6f}", s.count_right),
          fmt::format("identity switches            {}", s.identity.switches),
          fmt::format("false identities             {}", s.identity.false_ids),
          fmt::format("NEES per degree              {:.6f} ({:.3f} to {:.3f} if honest and independent)",
                      s.nees.mean_per_degree, s.nees.lower, s.nees.upper)};
}

nlohmann::json summary_of(const TargetScores& s) {
  return {{"moments", s.moments},
          {"pairs", s.pairs},
          {"gospa_m", s.gospa_m},
          {"ospa_m", s.ospa_m},
          {"gospa_parts_m2", {{"localisation", s.localisation_m2}, {"missed", s.missed_m2}, {"false", s.false_m2}}},
          {"rms_m", s.rms_m},
          {"median_m", s.median_m},
          {"completeness", s.identity.completeness},
          {"purity", s.identity.purity},
          {"count_right", s.count_right},
          {"identity_switches", s.identity.switches},
          {"false_identities", s.identity.false_ids},
          {"nees", {{"mean_per_degree_of_freedom", s.nees.mean_per_degree}, {"count", s.nees.count}}}};
}

}  // namespace alidade
