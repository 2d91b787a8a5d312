// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "capture/recording/recording_repair.h"
#include "capture/recording/recording_verification.h"
#include "core/errors.h"

namespace alidade {

/// The recordings that a folder is or holds. Throws InputError where there are none.
std::vector<std::filesystem::path> find_recordings(const std::filesystem::path& folder);

/// What a repair did, in a line and for --json.
std::string line_of(const std::filesystem::path& recording, const RecordingRepair& repair);
nlohmann::json summary_of(const std::filesystem::path& recording, const RecordingRepair& repair);

struct VerifiedRecording {
  std::filesystem::path folder;
  RecordingVerification result;
};

/// What was found: a line, and one for each fault, "path:line: what", of the first 20; all of them for --json.
std::vector<std::string> lines_of(const VerifiedRecording& verified);
nlohmann::json summary_of(const VerifiedRecording& verified);

/// The one line for stderr of damaged recordings: the first fault, and how many more there are.
InputError error_of(std::span<const VerifiedRecording> damaged);

}  // namespace alidade
