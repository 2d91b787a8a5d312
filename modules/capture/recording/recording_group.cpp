// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/recording_group.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "capture/recording/recording.h"
#include "capture/recording/recording_names.h"
#include "capture/recording/session_file.h"
#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/text_lines.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json describe(const std::string& name, const RecordingSession& session) {
  json member{{"folder", name},
              {"source", session.camera.source},
              {"state", session.is_closed ? "closed" : "recording"},
              {"host_start_ns", session.start.host.time_since_epoch().count()}};
  if (session.video_start) member["video_start_ns"] = session.video_start->time_since_epoch().count();
  if (session.offset_at_start) member["device_to_host_at_start_ns"] = session.offset_at_start->count();
  if (session.offset_at_end) member["device_to_host_at_end_ns"] = session.offset_at_end->count();
  if (session.is_closed) member["frames"] = session.totals.frames;
  return member;
}

}  // namespace

void write_recording_group(const fs::path& folder, const std::string& program, std::span<const std::string> members) {
  json j{{"format", kGroupFormat}, {"version", 1}, {"program", program}, {"members", json::array()}};
  for (const std::string& name : members) j["members"].push_back(describe(name, read_session(folder / name)));
  write_file(folder / kSessionName, j.dump(2) + "\n");
}

std::vector<fs::path> recordings_of(const fs::path& folder) {
  if (is_recording(folder)) return {folder};
  const fs::path path = folder / kSessionName;
  if (!fs::exists(path)) return {};
  std::vector<fs::path> recordings;
  try {
    const json j = json::parse(read_bytes(path));
    if (j.value("format", "") != kGroupFormat) return {};
    for (const json& member : j.at("members")) recordings.push_back(folder / member.at("folder").get<std::string>());
  } catch (const json::exception& error) {
    throw InputError(path, 0, fmt::format("is damaged: {}", error.what()), "name one of the recordings in the folder");
  }
  return recordings;
}

}  // namespace alidade
