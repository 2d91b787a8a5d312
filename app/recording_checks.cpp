// SPDX-License-Identifier: Apache-2.0
#include "app/recording_checks.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "capture/recording/recording_group.h"

namespace alidade {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string counted(std::int64_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

// "300 frames (1 recovered, 2 dropped)"
std::string describe(const RecordingTotals& totals) {
  std::vector<std::string> parts;
  const auto add = [&parts](auto count, const char* what) {
    if (count > 0) parts.push_back(fmt::format("{} {}", count, what));
  };
  add(totals.without_image, "without an image");
  add(totals.damaged, "damaged by the camera");
  add(totals.recovered, "recovered");
  std::string text = counted(totals.frames, "frame");
  if (!parts.empty()) text += fmt::format(" ({})", fmt::join(parts, ", "));
  if (totals.dropped > 0) text += fmt::format(", {} dropped by the camera", totals.dropped);
  if (totals.discarded > 0) text += fmt::format(", {} discarded since recording was too slow", totals.discarded);
  return text;
}

json to_json(const RecordingTotals& totals) {
  return {{"frames", totals.frames},   {"without_image", totals.without_image},
          {"damaged", totals.damaged}, {"recovered", totals.recovered},
          {"dropped", totals.dropped}, {"discarded", totals.discarded}};
}

std::string line_of(const RecordingFault& fault) {
  const std::string line = fault.line > 0 ? fmt::format(":{}", fault.line) : "";
  return fmt::format("{}{}: {}", fault.path.string(), line, fault.what);
}

}  // namespace

std::vector<fs::path> find_recordings(const fs::path& folder) {
  std::vector<fs::path> recordings = recordings_of(folder);
  if (recordings.empty())
    throw InputError(folder, 0, "is no recording", "name a folder that 'alidade record' has written");
  return recordings;
}

std::string line_of(const fs::path& recording, const RecordingRepair& repair) {
  const std::string what = describe(repair.totals);
  if (repair.was_closed) return fmt::format("{}: needs no repair, {}", recording.string(), what);
  std::string line = fmt::format("{}: closed with {}", recording.string(), what);
  if (repair.lost > 0) line += fmt::format("; {} that the disk never got given up", counted(repair.lost, "row"));
  if (repair.cut_bytes > 0)
    line += fmt::format("; {} of unfinished writing cut off", counted(repair.cut_bytes, "byte"));
  return line;
}

json summary_of(const fs::path& recording, const RecordingRepair& repair) {
  return {{"recording", recording.string()},
          {"was_closed", repair.was_closed},
          {"totals", to_json(repair.totals)},
          {"recovered", repair.recovered},
          {"lost", repair.lost},
          {"cut_bytes", repair.cut_bytes}};
}

std::vector<std::string> lines_of(const VerifiedRecording& verified) {
  constexpr std::size_t kMost = 20;
  const std::vector<RecordingFault>& faults = verified.result.faults;
  const std::string found = faults.empty() ? "no fault" : counted(static_cast<std::int64_t>(faults.size()), "fault");
  std::vector<std::string> lines{fmt::format("{}: {}, {:.1f} MB: {}", verified.folder.string(),
                                             describe(verified.result.totals),
                                             static_cast<double>(verified.result.bytes) * 1e-6, found)};
  for (std::size_t i = 0; i < std::min(kMost, faults.size()); ++i) lines.push_back(line_of(faults[i]));
  if (faults.size() > kMost) lines.push_back(fmt::format("and {} more", faults.size() - kMost));
  return lines;
}

json summary_of(const VerifiedRecording& verified) {
  json faults = json::array();
  for (const RecordingFault& fault : verified.result.faults) {
    faults.push_back({{"path", fault.path.string()}, {"line", fault.line}, {"what", fault.what}});
  }
  return {{"recording", verified.folder.string()},
          {"closed", verified.result.is_closed},
          {"totals", to_json(verified.result.totals)},
          {"bytes", verified.result.bytes},
          {"faults", std::move(faults)}};
}

InputError error_of(std::span<const VerifiedRecording> damaged) {
  std::size_t count = 0;
  for (const VerifiedRecording& verified : damaged) count += verified.result.faults.size();
  const VerifiedRecording& first = damaged.front();
  const RecordingFault& fault = first.result.faults.front();
  const std::string more =
      count > 1 ? fmt::format(" (and {} more)", counted(static_cast<std::int64_t>(count) - 1, "fault")) : "";
  const std::string remedy = first.result.is_closed ? "take it from a copy of the recording"
                                                    : fmt::format("run 'alidade repair {}'", first.folder.string());
  return {fault.path, fault.line, fault.what + more, remedy};
}

}  // namespace alidade
