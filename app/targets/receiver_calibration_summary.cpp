// SPDX-License-Identifier: Apache-2.0
#include "app/targets/receiver_calibration_summary.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

std::string key_of(ReceiverFault fault) {
  switch (fault) {
    case ReceiverFault::SwappedPlaces:
      return "swapped_places";
    case ReceiverFault::WrongPlace:
      return "wrong_place";
    case ReceiverFault::WrongFocal:
      return "wrong_focal";
    case ReceiverFault::UnevenClock:
      return "uneven_clock";
    case ReceiverFault::Unexplained:
      return "unexplained";
  }
  throw std::invalid_argument("key_of: no such fault");
}

std::string remedy_of(ReceiverFault fault, const ResectionOptions& options) {
  switch (fault) {
    case ReceiverFault::SwappedPlaces:
    case ReceiverFault::WrongPlace:
      return options.find_place ? "receivers.yaml has the place that its readings show"
                                : "let places be found (--resection-find-place)";
    case ReceiverFault::WrongFocal:
      return options.find_focal ? "receivers.yaml has them so"
                                : "calibrate its lens in this video mode, or let them be found "
                                  "(--resection-find-focal)";
    case ReceiverFault::UnevenClock:
      return "no even clock fits it; record it anew, or leave it out";
    case ReceiverFault::Unexplained:
      return "check its lens and whose readings these are, or leave it out";
  }
  throw std::invalid_argument("remedy_of: no such fault");
}

// With the names, where they are not said by the ids.
std::string text_of(const ReceiverCalibrationRun& run, const ReceiverFinding& finding) {
  std::vector<std::string> names;
  for (const CalibratedReceiver& one : run.receivers) {
    const bool is_meant = one.given.id == finding.receiver || one.given.id == finding.other;
    const bool has_name = name_of(one.given) != fmt::format("receiver {}", one.given.id);
    if (is_meant && has_name) names.push_back(one.given.name);
  }
  if (names.empty()) return describe(finding);
  return fmt::format("{} ({})", describe(finding), fmt::join(names, ", "));
}

nlohmann::json sigma_json(const ReceiverChange& sigma) {
  return {{"place_m", sigma.segment<3>(kTranslation).norm()},
          {"turn_rad", sigma.segment<3>(kRotation).norm()},
          {"clock_s", sigma[kClockOffset]},
          {"clock_rate", sigma[kClockRate]},
          {"readout_s", sigma[kReadout]},
          {"focal", sigma[kFocal]}};
}

nlohmann::json optional_number(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json json_of(const CalibratedReceiver& one) {
  nlohmann::json json{{"id", one.given.id},
                      {"name", one.given.name},
                      {"is_camera", one.given.camera.has_value()},
                      {"is_calibrated", one.is_calibrated()},
                      {"readings", one.after.readings},
                      {"median_before_px", optional_number(one.before.median_px)},
                      {"median_px", optional_number(one.after.median_px)}};
  if (!one.is_calibrated()) {
    json["left_why"] = one.left_why;
    return json;
  }
  json["change"] = {{"place_m", one.change.segment<3>(kTranslation).norm()},
                    {"turn_rad", one.change.segment<3>(kRotation).norm()},
                    {"clock_s", one.change[kClockOffset]},
                    {"clock_rate", one.change[kClockRate]},
                    {"readout_s", one.change[kReadout]},
                    {"focal", std::exp(one.change[kFocal])}};
  if (one.sigma) json["sigma"] = sigma_json(*one.sigma);
  if (one.wander_px) json["wander_px"] = *one.wander_px;
  return json;
}

nlohmann::json json_of(const ReceiverCalibrationRun& run, const ReceiverFinding& finding) {
  nlohmann::json json{{"fault", key_of(finding.fault)},
                      {"receiver", finding.receiver},
                      {"size", finding.size},
                      {"sigma", finding.sigma},
                      {"text", text_of(run, finding)}};
  if (finding.other >= 0) json["other"] = finding.other;
  return json;
}

}  // namespace

void add_warnings(ReceiverCalibrationRun& run, const ReceiverCalibrationChoice& choice) {
  for (const CalibratedReceiver& one : run.receivers) {
    if (one.is_calibrated()) continue;
    run.warnings.push_back(fmt::format("{} is left as given: {}", name_of(one.given), one.left_why));
  }
  for (const ReceiverFinding& finding : run.findings) {
    run.warnings.push_back(fmt::format("{}; {}", text_of(run, finding), remedy_of(finding.fault, choice.resection)));
  }
  if (run.is_interrupted) run.warnings.emplace_back("interrupted: not all was done");
}

std::string explain_no_answer(const ReceiverCalibrationRun& run) {
  std::vector<std::string> reasons;
  for (const CalibratedReceiver& one : run.receivers) {
    if (one.given.camera) reasons.push_back(fmt::format("{}: {}", name_of(one.given), one.left_why));
  }
  return fmt::format(
      "no camera can be calibrated ({}); {}", fmt::join(reasons, "; "),
      run.has_truth() ? "check that path and observations are of one flight, not too short, and count time by one clock"
                      : "check poses and clocks, or give the target's path by --truth");
}

nlohmann::json summary_of(const ReceiverCalibrationRun& run) {
  nlohmann::json receivers = nlohmann::json::array(), findings = nlohmann::json::array();
  for (const CalibratedReceiver& one : run.receivers) receivers.push_back(json_of(one));
  for (const ReceiverFinding& finding : run.findings) findings.push_back(json_of(run, finding));
  nlohmann::json summary{
      {"source", run.sources.observations.empty() ? run.sources.receivers : run.sources.observations},
      {"method", run.has_truth() ? "resection" : "bundle"},
      {"receivers", receivers},
      {"findings", findings},
      {"calibration_s", run.calibration_s},
      {"interrupted", run.is_interrupted},
      {"warnings", run.warnings}};
  if (run.has_truth()) summary["truth"] = run.sources.truth;
  return summary;
}

std::vector<std::string> table_lines(const ReceiverCalibrationRun& run) {
  const auto px = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.2f}", *value) : std::string("no");
  };
  std::vector<std::string> lines;
  for (const CalibratedReceiver& one : run.receivers) {
    if (!one.is_calibrated()) {
      lines.push_back(fmt::format("{}: left as given", name_of(one.given)));
      continue;
    }
    lines.push_back(
        fmt::format("{}: {} readings, median {} px (was {}), moved {:.2f} m, turned {:.2f} mrad, clock {:+.1f} ms",
                    name_of(one.given), one.after.readings, px(one.after.median_px), px(one.before.median_px),
                    one.change.segment<3>(kTranslation).norm(), 1e3 * one.change.segment<3>(kRotation).norm(),
                    1e3 * one.change[kClockOffset]));
  }
  return lines;
}

}  // namespace alidade
