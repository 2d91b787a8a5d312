// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/target_scores.h"
#include "io/target_file.h"

namespace alidade {

/// Whether a file is a table of targets (has the columns `target` and `x_m`), and not a trajectory. A directory that
/// holds tracks.csv, or else truth.csv, is one, too: target_file_of names the table.
bool is_target_file(const std::filesystem::path& path);
std::filesystem::path target_file_of(const std::filesystem::path& path);

/// Truth and estimates side by side: at the estimates' times, and, at their usual distance, where there are none within
/// the truth's time. Estimates of different targets that are nearer than half that distance are of one moment: they are
/// moved to the first one's time by their velocity. True positions are taken on the straight line between rows, which
/// lie 1 s apart at most.
std::vector<TargetMoment> moments_of(std::span<const TargetRow> estimates, std::span<const TargetRow> truth);

/// The lines for the terminal.
std::vector<std::string> table_lines(const TargetScores& scores);

/// The content of summary.json.
nlohmann::json summary_of(const TargetScores& scores);

}  // namespace alidade
