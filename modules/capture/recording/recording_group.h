// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace alidade {

/// Writes session.json of a folder that holds recordings of several cameras, each in its own folder below: which they
/// are, and what their own sessions say of their clocks and times by now. To be called when all have begun, and again
/// when all are closed. `members`: names of the folders. Throws DeviceError, InputError.
void write_recording_group(const std::filesystem::path& folder, const std::string& program,
                           std::span<const std::string> members);

/// The recordings that a folder is: itself, or the members of a group, in their order; none where it is neither.
/// Throws InputError for a group whose session.json is damaged.
std::vector<std::filesystem::path> recordings_of(const std::filesystem::path& folder);

}  // namespace alidade
