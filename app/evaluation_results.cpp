// SPDX-License-Identifier: Apache-2.0
#include "app/evaluation_results.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace alidade {
namespace {

struct NamedSeries {
  std::string key;    // in summary.json, unit included
  std::string title;  // in the table
  const ErrorSeries* series;
};

std::vector<NamedSeries> series_of(const EvaluationRecord& record) {
  const Evaluation& e = record.evaluation;
  const std::string step = name_of(record.options.step);
  return {{"ape_translation_m", "APE translation [m]", &e.absolute.translation_m},
          {"ape_rotation_deg", "APE rotation [deg]", &e.absolute.rotation_deg},
          {"rpe_translation_m", fmt::format("RPE translation [m] over {}", step), &e.relative.translation_m},
          {"rpe_rotation_deg", fmt::format("RPE rotation [deg] over {}", step), &e.relative.rotation_deg},
          {"translation_percent_of_path", "translation [% of path]", &e.path.translation_percent},
          {"roll_pitch_yaw_deg", "roll, pitch, yaw [deg]", &e.path.rotation_deg}};
}

// null where there is no error at all, as for a step longer than the path.
nlohmann::json statistics_json(const Statistics& s) {
  if (s.count == 0) return nullptr;
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std},
          {"min", s.min},   {"max", s.max},   {"count", s.count}};
}

}  // namespace

std::string name_of(AlignmentKind alignment) {
  if (alignment == AlignmentKind::None) return "none";
  return alignment == AlignmentKind::Rigid ? "se3" : "sim3";
}

std::string name_of(const Step& step) {
  if (const auto* path = std::get_if<PathStep>(&step)) return fmt::format("{} m", path->metres);
  if (const auto* time = std::get_if<TimeStep>(&step)) return fmt::format("{} s", time->seconds);
  const std::size_t frames = std::get<FrameStep>(step).frames;
  return fmt::format("{} frame{}", frames, frames == 1 ? "" : "s");
}

std::vector<std::string> table_lines(const EvaluationRecord& record) {
  const Evaluation& e = record.evaluation;
  const std::string how = record.by_index
                              ? "by number"
                              : fmt::format("by time, at most {} s apart", record.association.max_time_difference_s);
  std::vector<std::string> lines{
      fmt::format("estimate    {} ({} poses)", record.estimate.path.string(), record.estimate.poses.size()),
      fmt::format("truth       {} ({} poses)", record.truth.path.string(), record.truth.poses.size()),
      fmt::format("associated  {} poses {}", e.pairs.truth.size(), how),
      fmt::format("alignment   {}, scale {:.6f}", name_of(record.options.alignment), e.alignment.scale),
      fmt::format("path        {:.6f} m", e.path.path_length_m),
      fmt::format("{:<36}{:>13}{:>13}{:>13}{:>13}{:>13}{:>13}", "", "rmse", "mean", "median", "std", "min", "max")};
  for (const NamedSeries& named : series_of(record)) {
    const Statistics& s = named.series->statistics;
    if (s.count == 0) {
      lines.push_back(fmt::format("{:<36}{:>13}", named.title, "none"));
      continue;
    }
    lines.push_back(fmt::format("{:<36}{:>13.6f}{:>13.6f}{:>13.6f}{:>13.6f}{:>13.6f}{:>13.6f}", named.title, s.rmse,
                                s.mean, s.median, s.std, s.min, s.max));
  }
  if (const auto& c = e.consistency) {
    lines.push_back(
        fmt::format("NEES per degree of freedom {:.3f} over {} poses (1 is honest; 95 % bounds {:.3f} to {:.3f})",
                    c->mean_per_degree, c->count, c->lower, c->upper));
  }
  return lines;
}

nlohmann::json summary_of(const EvaluationRecord& record) {
  const Evaluation& e = record.evaluation;
  nlohmann::json summary{
      {"estimate", record.estimate.path.string()},      {"truth", record.truth.path.string()},
      {"estimate_poses", record.estimate.poses.size()}, {"truth_poses", record.truth.poses.size()},
      {"associated_poses", e.pairs.truth.size()},       {"associated_by", record.by_index ? "index" : "time"},
      {"alignment", name_of(record.options.alignment)}, {"scale", e.alignment.scale},
      {"path_length_m", e.path.path_length_m},          {"rpe_step", name_of(record.options.step)}};
  for (const NamedSeries& named : series_of(record)) summary[named.key] = statistics_json(named.series->statistics);
  if (const auto& c = e.consistency) {
    summary["nees"] = {{"mean_per_degree_of_freedom", c->mean_per_degree},
                       {"count", c->count},
                       {"lower_95_percent", c->lower},
                       {"upper_95_percent", c->upper}};
  }
  return summary;
}

std::string errors_csv(const EvaluationRecord& record) {
  const Evaluation& e = record.evaluation;
  std::string text = "t_ns,translation_m,rotation_deg,of_path_percent,nees\n";
  for (std::size_t i = 0; i < e.pairs.truth.size(); ++i) {
    const bool has_nees = e.consistency && e.consistency->nees[i];
    text +=
        fmt::format("{},{},{},{},{}\n", e.pairs.truth[i].time.time_since_epoch().count(),
                    e.absolute.translation_m.values[i], e.absolute.rotation_deg.values[i],
                    e.path.translation_percent.values[i], has_nees ? fmt::format("{}", *e.consistency->nees[i]) : "");
  }
  return text;
}

}  // namespace alidade
