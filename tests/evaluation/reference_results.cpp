// SPDX-License-Identifier: Apache-2.0
#include "tests/evaluation/reference_results.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "core/errors.h"
#include "evaluation/evaluate.h"
#include "io/trajectory_file.h"

namespace alidade {
namespace {

ReferenceCase parse_heading(const std::filesystem::path& folder, const std::string& line) {
  std::istringstream words(line.substr(3));
  std::string tool, format, truth, estimate, flag;
  words >> tool >> format >> truth >> estimate;
  ReferenceCase reference{line.substr(3), folder / truth, folder / estimate, AlignmentKind::None, false, false, {}};
  reference.relative = tool == "evo_rpe";
  while (words >> flag) {
    if (flag == "-a") reference.alignment = AlignmentKind::Rigid;
    if (flag == "-as") reference.alignment = AlignmentKind::Similarity;
    if (flag == "angle_deg") reference.angle = true;
  }
  return reference;
}

Statistics evaluate_case(const ReferenceCase& reference) {
  const TrajectoryFile estimate = read_trajectory(reference.estimate);
  const TrajectoryFile truth = read_trajectory(reference.truth);
  const PairedTrajectories pairs = estimate.has_times ? associate_by_time(estimate.poses, truth.poses)
                                                      : PairedTrajectories{estimate.poses, truth.poses};
  const Evaluation e = evaluate(pairs, {reference.alignment, FrameStep{1}}).value();
  if (reference.relative) return (reference.angle ? e.relative.rotation_deg : e.relative.translation_m).statistics;
  return (reference.angle ? e.absolute.rotation_deg : e.absolute.translation_m).statistics;
}

}  // namespace

std::vector<ReferenceCase> read_reference_cases(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "reference-results.txt";
  std::ifstream file(path);
  if (!file) throw InputError(path.string(), 0, "cannot be read", "give the folder of reference-results.txt");
  std::vector<ReferenceCase> cases;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream words(line);
    std::string statistic, value;
    if (line.starts_with("## ")) {
      cases.push_back(parse_heading(folder, line));
    } else if (!cases.empty() && words >> statistic >> value) {
      cases.back().printed.emplace_back(statistic, value);
    } else if (!line.empty()) {
      throw InputError(path.string(), number, "is neither a heading nor a statistic", "copy the file again");
    }
  }
  return cases;
}

std::vector<ReferenceValue> compare(const ReferenceCase& reference) {
  const Statistics s = evaluate_case(reference);
  const std::map<std::string, double> ours{{"max", s.max},   {"mean", s.mean}, {"median", s.median},
                                           {"rmse", s.rmse}, {"std", s.std},   {"min", s.min}};
  std::vector<ReferenceValue> values;
  for (const auto& [statistic, printed] : reference.printed) {
    values.push_back({statistic, printed, fmt::format("{:.6f}", ours.at(statistic))});
  }
  return values;
}

}  // namespace alidade
