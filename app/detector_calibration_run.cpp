// SPDX-License-Identifier: Apache-2.0
#include "app/detector_calibration_run.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

using StatisticsById = std::map<int, ReadingStatistics>;

std::vector<double> list_of(const Vector6d& values) {
  return {values.begin(), values.end()};
}

std::string name_of(CalibrationOutcome outcome) {
  switch (outcome) {
    case CalibrationOutcome::Refined:
      return "refined";
    case CalibrationOutcome::TooFewReadings:
      return "too few readings";
    case CalibrationOutcome::NoStart:
      return "no start";
    case CalibrationOutcome::Undetermined:
      return "undetermined";
    case CalibrationOutcome::Stopped:
      return "stopped";
  }
  return "";
}

nlohmann::json json_of(const StatisticsById& statistics) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [id, s] : statistics) {
    list.push_back({{"id", id},
                    {"readings", s.count},
                    {"explained", s.inlier_count},
                    {"median_sigmas", s.median_sigmas},
                    {"rms_sigmas", s.rms_sigmas}});
  }
  return list;
}

nlohmann::json json_of(const Statistics& s) {
  return {{"mean_m", s.mean}, {"median_m", s.median}, {"rmse_m", s.rmse}, {"max_m", s.max}, {"count", s.count}};
}

nlohmann::json json_of(const ReferenceErrors& errors) {
  nlohmann::json json{{"asked", errors.asked},
                      {"answered", errors.answered},
                      {"answered_share", errors.answered_share()},
                      {"before", json_of(errors.before_m)},
                      {"after", json_of(errors.after_m)}};
  if (errors.onboard_m) {
    json["onboard"] = json_of(*errors.onboard_m);
    json["ratio"] = errors.after_m.mean / errors.onboard_m->mean;
  }
  return json;
}

nlohmann::json json_of(const DetectorVerification& v) {
  nlohmann::json json{
      {"outcome", name_of(v.after.outcome)},
      {"before", {{"detectors", json_of(v.before.by_detector)}, {"markers", json_of(v.before.by_marker)}}},
      {"after", {{"detectors", json_of(v.after.by_detector)}, {"markers", json_of(v.after.by_marker)}}},
      {"windows",
       {{"count", v.windows.windows},
        {"explained", v.windows.explained},
        {"explained_share", v.windows.explained_share()},
        {"most_parameters", v.windows.largest_fit},
        {"median_sigmas", v.windows.median_sigmas}}}};
  if (v.windows.median_rad) json["windows"]["median_rad"] = *v.windows.median_rad;
  if (v.errors) json["reference"] = json_of(*v.errors);
  return json;
}

// A typical residual of all: the median over detectors of their medians would hide a bad one, the worst is told.
double worst_median(const StatisticsById& statistics) {
  double worst = 0.0;
  for (const auto& [id, s] : statistics) worst = std::max(worst, s.median_sigmas);
  return worst;
}

std::vector<std::string> verification_lines(const DetectorVerification& v) {
  if (v.after.outcome != CalibrationOutcome::Refined) {
    return {fmt::format("verification: {}, the refined detectors were not tried", name_of(v.after.outcome))};
  }
  std::vector<std::string> lines;
  lines.push_back(fmt::format("verification: worst median residual {:.2f} sigma (detectors as given: {:.2f})",
                              worst_median(v.after.by_detector), worst_median(v.before.by_detector)));
  const WindowStatistics& w = v.windows;
  lines.push_back(fmt::format("windows: {:.2f} % of {} explained, each by itself, median residual {:.3f} sigma{}",
                              100.0 * w.explained_share(), w.windows, w.median_sigmas,
                              w.median_rad ? fmt::format(" ({:.4f} mrad)", 1e3 * *w.median_rad) : ""));
  if (!v.errors) return lines;
  lines.push_back(fmt::format("mean error: {:.2f} mm, with the detectors as given {:.2f} mm ({} of {} instants)",
                              1e3 * v.errors->after_m.mean, 1e3 * v.errors->before_m.mean, v.errors->answered,
                              v.errors->asked));
  if (v.errors->onboard_m) {
    lines.push_back(fmt::format("the other estimate: {:.2f} mm at the same instants; ratio {:.3f}",
                                1e3 * v.errors->onboard_m->mean, v.errors->after_m.mean / v.errors->onboard_m->mean));
  }
  return lines;
}

}  // namespace

std::string explain(CalibrationOutcome outcome) {
  switch (outcome) {
    case CalibrationOutcome::TooFewReadings:
      return "too few readings: 24 of each station are the least; record longer, or leave out stations that see "
             "nothing";
    case CalibrationOutcome::NoStart:
      return "no pose of the body explains the first readings; are the body, the detectors and the unit of the "
             "readings those of this recording? else place the stations better, to some degrees";
    case CalibrationOutcome::Undetermined:
      return "the readings do not determine where the stations stand; move and turn the body through the whole space, "
             "in view of several stations at once";
    case CalibrationOutcome::Stopped:
      return "stopped before the stations were moved";
    case CalibrationOutcome::Refined:
      break;
  }
  return "refined";
}

void add_warnings(DetectorCalibrationRun& run) {
  if (run.interrupted) run.warnings.emplace_back("interrupted: the detectors are those of the last iteration");
  if (!run.refined.is_converged && !run.interrupted) {
    run.warnings.push_back(fmt::format("the calibration has not settled after {} iterations; raise --max-iterations",
                                       run.refined.iterations));
  }
  if (!run.verification || run.verification->after.outcome == CalibrationOutcome::Refined) return;
  run.warnings.push_back(fmt::format("not verified: {}", explain(run.verification->after.outcome)));
}

std::vector<StationMove> station_moves(const DetectorCalibrationRun& run) {
  std::vector<StationMove> moves;
  for (std::size_t i = 0; i < run.refined.rig.detectors.size(); ++i) {
    const LineDetector& now = run.refined.rig.detectors[i];
    const bool is_told =
        std::any_of(moves.begin(), moves.end(), [&](const auto& m) { return m.station == now.station; });
    if (is_told) continue;
    StationMove move{now.station, difference(run.given.rig.detectors[i].T_world_station, now.T_world_station), {}};
    const auto covariance = run.refined.rig.station_covariance.find(now.station);
    if (covariance != run.refined.rig.station_covariance.end()) {
      move.sigma = covariance->second.diagonal().cwiseSqrt();
    }
    moves.push_back(std::move(move));
  }
  return moves;
}

nlohmann::json summary_of(const DetectorCalibrationRun& run) {
  nlohmann::json stations = nlohmann::json::array();
  for (const StationMove& move : station_moves(run)) {
    nlohmann::json station{{"name", move.station}, {"held", !move.sigma}, {"change_m_rad", list_of(move.change)}};
    if (move.sigma) station["sigma_m_rad"] = list_of(*move.sigma);
    stations.push_back(std::move(station));
  }
  nlohmann::json summary{{"source", run.source},
                         {"outcome", name_of(run.refined.outcome)},
                         {"converged", run.refined.is_converged},
                         {"iterations", run.refined.iterations},
                         {"truth_aided", run.has_reference},
                         {"calibration_s", run.calibration_s},
                         {"interrupted", run.interrupted},
                         {"stations", stations},
                         {"detectors", json_of(run.refined.by_detector)},
                         {"markers", json_of(run.refined.by_marker)},
                         {"warnings", run.warnings}};
  if (run.verification) summary["verification"] = json_of(*run.verification);
  return summary;
}

std::vector<std::string> table_lines(const DetectorCalibrationRun& run) {
  std::vector<std::string> lines{fmt::format("calibration: {} after {} iterations, {:.1f} s",
                                             run.refined.is_converged ? "settled" : "not settled",
                                             run.refined.iterations, run.calibration_s)};
  for (const StationMove& move : station_moves(run)) {
    if (!move.sigma) {
      lines.push_back(fmt::format("station {}: held", move.station));
      continue;
    }
    lines.push_back(fmt::format("station {}: moved {:.2f} ± {:.2g} mm, turned {:.3f} ± {:.2g} mrad", move.station,
                                1e3 * move.change.head<3>().norm(), 1e3 * move.sigma->head<3>().norm(),
                                1e3 * move.change.tail<3>().norm(), 1e3 * move.sigma->tail<3>().norm()));
  }
  lines.push_back(fmt::format("worst median residual: {:.2f} sigma", worst_median(run.refined.by_detector)));
  if (run.verification) {
    for (std::string& line : verification_lines(*run.verification)) lines.push_back(std::move(line));
  } else {
    lines.emplace_back("verification: none; give --verify another recording, or --verify-start and --verify-end");
  }
  return lines;
}

}  // namespace alidade
