// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/session_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "capture/recording/camera_json.h"
#include "capture/recording/recording_names.h"
#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/text_lines.h"

namespace alidade {
namespace {

using nlohmann::json;
using std::chrono::nanoseconds;
constexpr int kVersion = 1;  // of the format

json to_json(const ClockReading& reading) {
  const nanoseconds host = reading.host.time_since_epoch();
  return {
      {"host_ns", host.count()}, {"utc_ns", reading.utc.count()}, {"utc_minus_host_ns", (reading.utc - host).count()}};
}

ClockReading clocks_of(const json& j) {
  return {HostTime(nanoseconds(j.at("host_ns").get<std::int64_t>())), nanoseconds(j.at("utc_ns").get<std::int64_t>())};
}

json to_json(const RecorderOptions& options) {
  json j{{"codec", options.codec ? std::string(name_of(*options.codec)) : "by rate"},
         {"busy_share", options.busy_share},
         {"assumed_fps_hz", options.assumed_fps_hz},
         {"keep_free_bytes", options.keep_free_bytes},
         {"writeback_s", options.writeback_s}};
  if (options.max_bytes) j["max_bytes"] = *options.max_bytes;
  return j;
}

RecorderOptions options_of(const json& j) {
  RecorderOptions options;
  options.codec = parse_lossless_codec(j.at("codec").get<std::string>());
  options.busy_share = j.at("busy_share");
  options.assumed_fps_hz = j.at("assumed_fps_hz");
  options.keep_free_bytes = j.at("keep_free_bytes");
  options.writeback_s = j.at("writeback_s");
  if (j.contains("max_bytes")) options.max_bytes = j.at("max_bytes").get<std::int64_t>();
  return options;
}

json to_json(const RecordingTotals& totals) {
  return {{"frames", totals.frames},   {"without_image", totals.without_image},
          {"damaged", totals.damaged}, {"recovered", totals.recovered},
          {"dropped", totals.dropped}, {"discarded", totals.discarded}};
}

RecordingTotals totals_of(const json& j) {
  return {j.at("frames"),    j.at("without_image"), j.at("damaged"),
          j.at("recovered"), j.at("dropped"),       j.at("discarded")};
}

json to_json(const std::vector<RecordedFile>& files) {
  json j = json::array();
  for (const RecordedFile& file : files) {
    j.push_back({{"name", file.name}, {"bytes", file.bytes}, {"crc32", fmt::format("{:08x}", file.crc32)}});
  }
  return j;
}

void set(json& j, const char* name, const std::optional<nanoseconds>& time) {
  if (time) j[name] = time->count();
}

std::optional<nanoseconds> get(const json& j, const char* name) {
  if (!j.contains(name)) return std::nullopt;
  return nanoseconds(j.at(name).get<std::int64_t>());
}

json to_json(const RecordingSession& session) {
  json j{{"format", kRecordingFormat},          {"version", kVersion},
         {"program", session.program},          {"state", session.is_closed ? "closed" : "recording"},
         {"camera", to_json(session.camera)},   {"request", to_json(session.request)},
         {"options", to_json(session.options)}, {"codec", name_of(session.codec.value())},
         {"start", to_json(session.start)}};
  if (session.is_repaired) j["repaired"] = true;
  if (session.video_start) j["video_start_ns"] = session.video_start->time_since_epoch().count();
  if (session.end) j["end"] = to_json(*session.end);
  set(j, "device_to_host_at_start_ns", session.offset_at_start);
  set(j, "device_to_host_at_end_ns", session.offset_at_end);
  if (!session.is_closed) return j;
  j["totals"] = to_json(session.totals);
  j["events"] = session.events;
  j["files"] = to_json(session.files);
  for (const auto& [name, count] : session.statistics) j["statistics"][name] = count;
  return j;
}

LosslessCodec codec_of(const std::string& name) {
  if (const auto codec = parse_lossless_codec(name)) return *codec;
  throw std::invalid_argument("there is no codec '" + name + "'");
}

RecordingSession session_of(const json& j) {
  RecordingSession session;
  session.program = j.at("program");
  session.is_closed = j.at("state") == "closed";
  session.is_repaired = j.value("repaired", false);
  session.camera = camera_facts_of(j.at("camera"));
  session.request = camera_request_of(j.at("request"));
  session.options = options_of(j.at("options"));
  session.codec = codec_of(j.at("codec"));
  if (const auto start = get(j, "video_start_ns")) session.video_start = Timestamp(*start);
  session.start = clocks_of(j.at("start"));
  if (j.contains("end")) session.end = clocks_of(j.at("end"));
  session.offset_at_start = get(j, "device_to_host_at_start_ns");
  session.offset_at_end = get(j, "device_to_host_at_end_ns");
  if (!session.is_closed) return session;
  session.totals = totals_of(j.at("totals"));
  session.events = j.at("events");
  for (const json& file : j.at("files")) {
    const std::string crc = file.at("crc32");
    session.files.push_back(
        {file.at("name"), file.at("bytes"), static_cast<std::uint32_t>(std::stoul(crc, nullptr, 16))});
  }
  if (!j.contains("statistics")) return session;
  for (const auto& [name, count] : j.at("statistics").items()) session.statistics.emplace_back(name, count);
  return session;
}

}  // namespace

ClockReading read_clocks() {
  const auto utc = std::chrono::system_clock::now().time_since_epoch();
  return {HostClock::now(), std::chrono::duration_cast<nanoseconds>(utc)};
}

PixelLayout layout_of(const PixelFormat& format) {
  switch (format.kind) {
    case PixelKind::Grey:
    case PixelKind::Bayer:
      return format.bits > 8 ? PixelLayout::Grey16 : PixelLayout::Grey8;
    case PixelKind::Bgr:
      return PixelLayout::Bgr24;
    case PixelKind::Yuyv:
      return PixelLayout::Yuyv;
    case PixelKind::Nv12:
      return PixelLayout::Nv12;
    case PixelKind::Jpeg:
      break;
  }
  return PixelLayout::Jpeg;
}

LosslessFormat RecordingSession::format() const {
  return {layout_of(camera.format), camera.size, codec.value()};
}

void write_session(const std::filesystem::path& folder, const RecordingSession& session) {
  write_file(folder / kSessionName, to_json(session).dump(2) + "\n");
}

RecordingSession read_session(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kSessionName;
  const std::string text = read_bytes(path);
  try {
    const json j = json::parse(text);
    if (j.value("format", "") != kRecordingFormat) {
      throw InputError(path, 0, "is not the session of one camera's recording", "name the folder of a recording");
    }
    if (j.at("version") != kVersion) {
      throw InputError(path, 0,
                       fmt::format("is of version {} of the format, known is {}", j.at("version").dump(), kVersion),
                       "use the program that recorded it, or a newer one");
    }
    return session_of(j);
  } catch (const json::exception& error) {
    throw InputError(path, 0, fmt::format("is damaged: {}", error.what()), "take it from a copy of the recording");
  } catch (const std::logic_error& error) {  // a checksum that is no number
    throw InputError(path, 0, fmt::format("is damaged: {}", error.what()), "take it from a copy of the recording");
  }
}

}  // namespace alidade
