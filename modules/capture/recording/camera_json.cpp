// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/camera_json.h"

#include <array>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace alidade {
namespace {

using nlohmann::json;
using std::chrono::nanoseconds;

constexpr std::array<std::pair<StampedMoment, const char*>, 3> kMoments{
    {{StampedMoment::Unknown, "unknown"},
     {StampedMoment::ExposureStart, "exposure start"},
     {StampedMoment::ReadoutEnd, "readout end"}}};
constexpr std::array<std::pair<CameraTrigger, const char*>, 3> kTriggers{{{CameraTrigger::FreeRunning, "free running"},
                                                                          {CameraTrigger::Software, "software"},
                                                                          {CameraTrigger::Hardware, "hardware"}}};

template <class Choices, class Value>
const char* name_in(const Choices& choices, Value value) {
  for (const auto& [known, name] : choices) {
    if (known == value) return name;
  }
  return "";
}

// Throws std::invalid_argument for a name that is none of them.
template <class Choices>
auto value_in(const Choices& choices, const std::string& name) {
  for (const auto& [value, known] : choices) {
    if (known == name) return value;
  }
  throw std::invalid_argument("there is no choice '" + name + "'");
}

template <class Value>
void set(json& j, const char* name, const std::optional<Value>& value) {
  if (value) j[name] = *value;
}
void set(json& j, const char* name, const std::optional<nanoseconds>& value) {
  if (value) j[name] = value->count();
}

template <class Value>
void get(const json& j, const char* name, std::optional<Value>& value) {
  if (j.contains(name)) value = j.at(name).get<Value>();
}
void get(const json& j, const char* name, std::optional<nanoseconds>& value) {
  if (j.contains(name)) value = nanoseconds(j.at(name).get<std::int64_t>());
}

}  // namespace

json to_json(const CameraFacts& facts) {
  json j{{"source", facts.source},
         {"model", facts.model},
         {"serial", facts.serial},
         {"size_px", {facts.size.width, facts.size.height}},
         {"pixel_format", name_of(facts.format)},
         {"device_format", facts.device_format},
         {"clock", facts.clock},
         {"is_host_clock", facts.is_host_clock},
         {"stamped", name_in(kMoments, facts.stamped)}};
  set(j, "period_ns", facts.period);
  set(j, "exposure_ns", facts.exposure);
  return j;
}

CameraFacts camera_facts_of(const json& j) {
  CameraFacts facts;
  facts.source = j.at("source");
  facts.model = j.at("model");
  facts.serial = j.at("serial");
  facts.size = {j.at("size_px").at(0).get<int>(), j.at("size_px").at(1).get<int>()};
  const std::string format = j.at("pixel_format");
  const auto known = parse_pixel_format(format);
  if (!known) throw std::invalid_argument("there is no pixel format '" + format + "'");
  facts.format = *known;
  facts.device_format = j.at("device_format");
  facts.clock = j.at("clock");
  facts.is_host_clock = j.at("is_host_clock");
  facts.stamped = value_in(kMoments, j.at("stamped").get<std::string>());
  get(j, "period_ns", facts.period);
  get(j, "exposure_ns", facts.exposure);
  return facts;
}

json to_json(const CameraRequest& request) {
  json j{{"trigger", name_in(kTriggers, request.trigger)}};
  if (request.offset) j["offset_px"] = {request.offset->x, request.offset->y};
  if (request.size) j["size_px"] = {request.size->width, request.size->height};
  set(j, "pixel_format", request.pixel_format);
  set(j, "fps_hz", request.fps_hz);
  set(j, "exposure_s", request.exposure_s);
  set(j, "gain", request.gain);
  set(j, "packet_size_bytes", request.packet_size);
  j["settings"] = request.settings;
  return j;
}

CameraRequest camera_request_of(const json& j) {
  CameraRequest request;
  request.trigger = value_in(kTriggers, j.at("trigger").get<std::string>());
  if (j.contains("offset_px"))
    request.offset = {j.at("offset_px").at(0).get<int>(), j.at("offset_px").at(1).get<int>()};
  if (j.contains("size_px")) request.size = {j.at("size_px").at(0).get<int>(), j.at("size_px").at(1).get<int>()};
  get(j, "pixel_format", request.pixel_format);
  get(j, "fps_hz", request.fps_hz);
  get(j, "exposure_s", request.exposure_s);
  get(j, "gain", request.gain);
  get(j, "packet_size_bytes", request.packet_size);
  j.at("settings").get_to(request.settings);
  return request;
}

}  // namespace alidade
