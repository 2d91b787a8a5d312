// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/experiments/camera_runs.h"
#include "app/experiments/camera_scores.h"
#include "app/experiments/experiment_section.h"

namespace alidade {

/// What a method makes of a run; some give several estimates at once (causal, with lag, smoothed).
using NamedTrajectories = std::vector<std::pair<std::string, Trajectory>>;
using CameraMethod = std::function<NamedTrajectories(const CameraRun&)>;

/// Each frame by itself.
CameraMethod single_frames(const CameraScene& scene, std::string name, PnpMethod method);

/// Our filter: "ours, causal", "ours, lag N" and "ours, smoothed".
CameraMethod our_filter(const CameraScene& scene, CameraFilterOptions options, std::vector<int> lags);

/// Runs that are not scored: to learn from.
std::vector<CameraRun> unscored_runs(const CameraScene& scene, const ExperimentContext& context, int count);

/// Our filter's options with the motion noise learned from ten such runs.
CameraFilterOptions learned_options(const CameraScene& scene, const ExperimentContext& context);

/// All methods on all scored runs, in parallel; `prepare` changes a run before. Ends early when the user stops it.
std::map<std::string, MethodErrors> compare(const CameraScene& scene, const ExperimentContext& context,
                                            const std::string& stage, const std::vector<CameraMethod>& methods,
                                            const std::function<CameraRun(CameraRun)>& prepare = {});

/// One row per method: its errors, and in proportion to those of the method `reference`.
ReportTable error_table(const std::string& title, const CameraScene& scene,
                        const std::map<std::string, MethodErrors>& errors, const std::string& reference);

/// The same for summary.json.
nlohmann::json summary_of(const std::map<std::string, MethodErrors>& errors, const std::string& reference);

/// "0.877 (0.861-0.893)".
std::string with_interval(const Ratio& ratio);

/// {"value", "low", "high"}.
nlohmann::json as_json(const Ratio& ratio);

/// An error as a share of the scene's path, in percent.
std::string of_path_percent(double error_m, const CameraScene& scene);

}  // namespace alidade
