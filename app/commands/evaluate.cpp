// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands/verbs.h"
#include "app/evaluation_report.h"
#include "app/evaluation_results.h"
#include "app/result_directory.h"
#include "app/targets/target_evaluation.h"
#include "io/image_files.h"

namespace alidade {
namespace {

enum class StepUnit { Frames, Metres, Seconds };

TrajectoryFile read_with_covariances(const std::filesystem::path& path) {
  TrajectoryFile file = read_trajectory(path);
  const std::filesystem::path covariances = covariance_path(file.path);
  if (std::filesystem::exists(covariances)) file.poses = read_covariances(covariances, std::move(file.poses));
  return file;
}

PairedTrajectories pair_by_index(const EvaluationRecord& record) {
  const std::size_t estimated = record.estimate.poses.size(), known = record.truth.poses.size();
  if (estimated != known) {
    throw InputError(record.estimate.path.string(), 0,
                     fmt::format("has {} poses, {} has {}: without times pose i belongs to pose i", estimated,
                                 record.truth.path.string(), known),
                     "give both one pose per frame, or both times (TUM)");
  }
  return {record.estimate.poses, record.truth.poses};
}

PairedTrajectories pair(const EvaluationRecord& record) {
  constexpr std::size_t kFewest = 3;  // that determine an alignment
  const AssociationOptions& options = record.association;
  PairedTrajectories pairs =
      record.by_index ? pair_by_index(record) : associate_by_time(record.estimate.poses, record.truth.poses, options);
  if (pairs.truth.size() >= kFewest) return pairs;
  if (record.by_index) {
    throw InputError(record.estimate.path.string(), 0, fmt::format("has {} poses, 3 are needed", pairs.truth.size()),
                     "give a longer trajectory");
  }
  throw InputError(
      record.estimate.path.string(), 0,
      fmt::format("{} of {} poses lie within {} s of a pose of {}, 3 are needed; the nearest two are {:.6g} s apart",
                  pairs.truth.size(), record.estimate.poses.size(), options.max_time_difference_s,
                  record.truth.path.string(),
                  shortest_time_apart_s(record.estimate.poses, record.truth.poses, options.time_offset_s)),
      "set --time-offset-s or --max-time-difference-s, or pair pose i with pose i by --by-index");
}

class EvaluateCommand : public Command {
 public:
  explicit EvaluateCommand(CLI::App& flags) {
    flags.add_option("ESTIMATE", estimate_, "trajectory, tracks of targets, or the result directory of a track")
        ->required();
    flags.add_option("TRUTH", truth_, "trajectory, dataset directory with known poses, or true paths of targets")
        ->required();
    options_.add_choice(
        "align", alignment_,
        {{"none", AlignmentKind::None}, {"se3", AlignmentKind::Rigid}, {"sim3", AlignmentKind::Similarity}},
        "what brings the estimate into the frame of the truth first");
    options_.add("by_index", by_index_, "", "pair pose i with pose i instead of by time");
    options_.add("max_time_difference_s", association_.max_time_difference_s, "s", "between the poses of a pair");
    options_.add("time_offset_s", association_.time_offset_s, "s", "added to the times of the estimate");
    options_.add("rpe_step", step_, "", "over which the relative errors are taken, in rpe_unit");
    options_.add_choice("rpe_unit", unit_,
                        {{"frames", StepUnit::Frames}, {"m", StepUnit::Metres}, {"s", StepUnit::Seconds}},
                        "unit of rpe_step");
    options_.add("cutoff_m", cutoff_m_, "m", "of targets: an estimate farther from one is none of it");
    options_.add_check([this] { check(); });
  }

  ExitCode run(const RunContext& context) override {
    return is_target_file(estimate_) ? evaluate_targets(context) : evaluate_poses(context);
  }

 private:
  ExitCode evaluate_targets(const RunContext& context) const {
    const std::vector<TargetMoment> moments = moments_of(read_estimates(), read_target_rows(target_file_of(truth_)));
    if (std::ranges::all_of(moments, [](const TargetMoment& moment) { return moment.estimates.empty(); })) {
      throw InputError(target_file_of(estimate_).string(), 0,
                       fmt::format("no estimate lies within the time of {}", target_file_of(truth_).string()),
                       "set --time-offset-s");
    }
    const TargetScores scores = score_targets(moments, cutoff_m_);
    for (const std::string& line : table_lines(scores)) context.tell(line);
    context.publish(summary_of(scores));
    if (context.output.empty()) return ExitCode::Success;
    ResultDirectory directory(context.output, "evaluate");
    directory.write_text("options.yaml", options_.to_yaml());
    Report report{"Targets against the truth", context.arguments, rows_of(table_lines(scores)), {}, {}, {}, {}};
    report.options = options_.to_yaml();
    write_report(directory.path("report.html"), report);
    directory.commit(summary_of(scores));
    context.tell(fmt::format("written to {}", context.output.string()));
    return ExitCode::Success;
  }

  std::vector<TargetRow> read_estimates() const {
    std::vector<TargetRow> rows = read_target_rows(target_file_of(estimate_));
    for (TargetRow& row : rows) row.time += from_seconds(association_.time_offset_s);
    return rows;
  }

  ExitCode evaluate_poses(const RunContext& context) const {
    EvaluationRecord record{read_with_covariances(estimate_), read_trajectory(truth_), by_index_, association_, {}, {}};
    record.by_index |= !record.estimate.has_times || !record.truth.has_times;
    record.options = {alignment_, step()};
    const auto evaluation = evaluate(pair(record), record.options);
    if (!evaluation) {
      context.warn("the centres lie on one line or in one point, so that no alignment is determined; use --align none");
      return ExitCode::NoAnswer;
    }
    record.evaluation = *evaluation;
    for (const std::string& line : table_lines(record)) context.tell(line);
    context.publish(summary_of(record));
    if (!context.output.empty()) write(record, context);
    return ExitCode::Success;
  }

  void check() const {
    if (!(cutoff_m_ > 0)) throw std::invalid_argument(fmt::format("cutoff_m must be > 0 m, got {}", cutoff_m_));
    if (!(step_ > 0)) throw std::invalid_argument(fmt::format("rpe_step must be > 0, got {}", step_));
    if (unit_ == StepUnit::Frames && step_ < 1) {
      throw std::invalid_argument(fmt::format("rpe_step must be >= 1 frame, got {}", step_));
    }
    if (!(association_.max_time_difference_s >= 0)) {
      throw std::invalid_argument(
          fmt::format("max_time_difference_s must be >= 0 s, got {}", association_.max_time_difference_s));
    }
    if (!std::isfinite(association_.time_offset_s)) {
      throw std::invalid_argument(fmt::format("time_offset_s must be finite, got {}", association_.time_offset_s));
    }
  }

  Step step() const {
    if (unit_ == StepUnit::Metres) return PathStep{step_};
    if (unit_ == StepUnit::Seconds) return TimeStep{step_};
    return FrameStep{static_cast<std::size_t>(step_)};
  }

  void write(const EvaluationRecord& record, const RunContext& context) const {
    ResultDirectory directory(context.output, "evaluate");
    directory.write_text("errors.csv", errors_csv(record));
    directory.write_text("options.yaml", options_.to_yaml());
    write_image(directory.path("path.png"), draw_paths(record));
    write_image(directory.path("errors.png"), draw_errors(record));
    write_report(directory.path("report.html"), report_of(record, context.arguments, options_.to_yaml()));
    directory.commit(summary_of(record));
    context.tell(fmt::format("written to {}", context.output.string()));
  }

  std::filesystem::path estimate_, truth_;
  AlignmentKind alignment_ = EvaluationOptions{}.alignment;
  bool by_index_ = false;
  AssociationOptions association_;
  double step_ = 1, cutoff_m_ = SetMetricOptions{}.cutoff_m;
  StepUnit unit_ = StepUnit::Frames;
};

}  // namespace

Verb evaluate_verb() {
  return {"evaluate", "errors of a trajectory, or of tracks of targets, against the truth",
          "alidade evaluate estimate.tum groundtruth.txt --align sim3 -o evaluation\n"
          "alidade evaluate track/tracks.csv flight/truth.csv",
          OutputUse::Optional, make_command<EvaluateCommand>};
}

}  // namespace alidade
