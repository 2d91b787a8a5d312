// SPDX-License-Identifier: Apache-2.0
#include "app/camera_options.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

// Two whole numbers around `separator`, at least `least`.
std::optional<std::pair<int, int>> parse_pair(const std::string& text, char separator, int least) {
  int first = 0, second = 0, end = 0;
  const std::string pattern = fmt::format("%d{}%d%n", separator);
  if (std::sscanf(text.c_str(), pattern.c_str(), &first, &second, &end) != 2) return std::nullopt;
  if (static_cast<std::size_t>(end) != text.size() || first < least || second < least) return std::nullopt;
  return std::pair(first, second);
}

std::pair<int, int> parse_size(const std::string& text) {
  if (const auto size = parse_pair(text, 'x', 1)) return *size;
  throw std::invalid_argument(fmt::format("camera.size must be WIDTHxHEIGHT in px like 640x480, got '{}'", text));
}

std::pair<int, int> parse_offset(const std::string& text) {
  if (const auto offset = parse_pair(text, ',', 0)) return *offset;
  throw std::invalid_argument(fmt::format("camera.offset must be X,Y in px like 16,8, got '{}'", text));
}

double parse_gain(const std::string& text) {
  double gain = 0;
  int end = 0;
  const bool is_number = std::sscanf(text.c_str(), "%lf%n", &gain, &end) == 1;
  if (is_number && static_cast<std::size_t>(end) == text.size() && std::isfinite(gain)) return gain;
  throw std::invalid_argument(fmt::format("camera.gain must be a number, got '{}'", text));
}

struct Setting {
  std::string camera, name, value;
};

Setting parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t colon = text.substr(0, equals).find(':');
  const std::size_t begin = colon == std::string::npos ? 0 : colon + 1;
  if (equals == std::string::npos || equals == begin) {
    throw std::invalid_argument(fmt::format("--set must be NAME=VALUE or CAMERA:NAME=VALUE, got '{}'", text));
  }
  return {colon == std::string::npos ? "" : text.substr(0, colon), text.substr(begin, equals - begin),
          text.substr(equals + 1)};
}

}  // namespace

void bind(OptionFields& fields, CLI::App& flags, CameraOptions& o) {
  fields.add("camera.size", o.size, "px", "of a live camera's images, WIDTHxHEIGHT; empty, as below: as it stands");
  fields.add("camera.offset", o.offset, "px", "X,Y of the region on the sensor");
  fields.add("camera.pixel_format", o.pixel_format, "", "as 'alidade devices' lists it: YUYV, Mono12Packed");
  fields.add("camera.rate_hz", o.rate_hz, "Hz", "frames per second; 0, as below: as it stands");
  fields.add("camera.exposure_ms", o.exposure_ms, "ms", "switches an automatic exposure off");
  fields.add("camera.gain", o.gain, "", "in the camera's own unit; switches an automatic gain off");
  fields.add("camera.packet_size", o.packet_size, "bytes", "GigE Vision; 0: the largest that comes through");
  fields.add_choice("camera.trigger", o.trigger,
                    {{"free", CameraTrigger::FreeRunning},
                     {"software", CameraTrigger::Software},
                     {"hardware", CameraTrigger::Hardware}},
                    "software: exposed at the same moments by this host, all cameras alike; hardware: by a cable");
  fields.add("camera.give_up_s", o.give_up_s, "s", "without a frame, after which a lost camera is an error; 0: never");
  fields.add_check([&o] { validate(o); });
  flags.add_option("--set", o.settings, "controls or features of a live camera: ExposureAuto=Off, left:gain=3");
}

void validate(const CameraOptions& options) {
  request_of(options);
  const auto check = [](const char* field, double value) {
    if (!(value >= 0) || !std::isfinite(value)) {
      throw std::invalid_argument(fmt::format("camera.{} must be >= 0, got {}", field, value));
    }
  };
  check("rate_hz", options.rate_hz);
  check("exposure_ms", options.exposure_ms);
  check("give_up_s", options.give_up_s);
  check("packet_size", options.packet_size);
  if (options.trigger == CameraTrigger::Software && options.rate_hz == 0) {
    throw std::invalid_argument("camera.rate_hz must be > 0 for camera.trigger software, got 0");
  }
  validate(live_options_of(options));
}

CameraRequest request_of(const CameraOptions& options, const std::string& name) {
  CameraRequest request;
  if (!options.size.empty()) {
    const auto [width, height] = parse_size(options.size);
    request.size = cv::Size(width, height);
  }
  if (!options.offset.empty()) {
    const auto [x, y] = parse_offset(options.offset);
    request.offset = cv::Point(x, y);
  }
  if (!options.pixel_format.empty()) request.pixel_format = options.pixel_format;
  if (options.rate_hz > 0) request.fps_hz = options.rate_hz;
  if (options.exposure_ms > 0) request.exposure_s = 1e-3 * options.exposure_ms;
  if (!options.gain.empty()) request.gain = parse_gain(options.gain);
  if (options.packet_size > 0) request.packet_size = options.packet_size;
  request.trigger = options.trigger;
  for (const std::string& text : options.settings) {
    Setting setting = parse_setting(text);
    if (setting.camera.empty() || setting.camera == name) request.settings.emplace_back(setting.name, setting.value);
  }
  return request;
}

LiveCameraOptions live_options_of(const CameraOptions& options) {
  LiveCameraOptions live;
  if (options.give_up_s > 0) live.give_up_s = options.give_up_s;
  live.is_triggered = options.trigger == CameraTrigger::Hardware;
  return live;
}

}  // namespace alidade
