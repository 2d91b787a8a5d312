// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace alidade {

/// The files of a recording; all but the session are called NAME.part until it is closed.
inline constexpr const char* kSessionName = "session.json";
inline constexpr const char* kFramesName = "frames.csv";
inline constexpr const char* kEventsName = "events.csv";
inline constexpr const char* kVideoName = "video.mkv";

/// Where a file of a recording is: NAME, or NAME.part while it is not closed; NAME where there is neither.
std::filesystem::path find_recorded(const std::filesystem::path& folder, const char* name);

/// "format" in session.json.
inline constexpr const char* kRecordingFormat = "alidade recording";
inline constexpr const char* kGroupFormat = "alidade recordings";

}  // namespace alidade
