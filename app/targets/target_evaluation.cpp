// SPDX-License-Identifier: Apache-2.0
#include "app/targets/target_evaluation.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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

Duration usual_step(const std::set<Timestamp>& times) {
  std::vector<Duration> steps;
  for (auto t = times.begin(); t != times.end() && std::next(t) != times.end(); ++t)
    steps.push_back(*std::next(t) - *t);
  if (steps.empty()) return from_seconds(kLongestGap_s);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

// The estimates' times, and more at their usual distance from `first` to `last` where these leave a gap.
std::set<Timestamp> all_times(const std::set<Timestamp>& times, Timestamp first, Timestamp last) {
  const Duration step = usual_step(times);
  std::set<Timestamp> all = times;
  Timestamp before = times.empty() ? last + step : *times.begin();
  for (Timestamp t = before - step; t >= first; t -= step) all.insert(t);
  for (const Timestamp next : times) {
    for (Timestamp t = before + step; t + step / 2 < next; t += step) all.insert(t);
    before = next;
  }
  for (Timestamp t = before + step; t <= last; t += step) all.insert(t);
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
  return fs::is_directory(path) ? path / "tracks.csv" : path;
}

std::vector<TargetMoment> moments_of(std::span<const TargetRow> estimates, std::span<const TargetRow> truth) {
  std::map<Timestamp, std::vector<IdentifiedPosition>> told;
  std::set<Timestamp> times;
  for (const TargetRow& row : estimates) {
    IdentifiedPosition position{row.target, row.p_world, {}};
    if (row.covariance) position.covariance = row.covariance->topLeftCorner<3, 3>();
    told[row.time].push_back(position);
    times.insert(row.time);
  }
  Timestamp first = Timestamp::max(), last = Timestamp::min();
  for (const TargetRow& row : truth) first = std::min(first, row.time), last = std::max(last, row.time);
  const auto paths = paths_of(truth);
  std::vector<TargetMoment> moments;
  for (const Timestamp time : all_times(times, first, last)) {
    if (time < first || time > last) continue;
    TargetMoment moment{time, {}, {}};
    for (const auto& [target, path] : paths) {
      if (const auto p = position_at(path, time, from_seconds(kLongestGap_s))) moment.truth.push_back({target, *p, {}});
    }
    if (const auto found = told.find(time); found != told.end()) moment.estimates = found->second;
    moments.push_back(std::move(moment));
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
