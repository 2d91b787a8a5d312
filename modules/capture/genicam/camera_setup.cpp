// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/camera_setup.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <arv.h>
#include <fmt/format.h>

#include "capture/genicam/camera_features.h"

namespace alidade {
namespace {

// A camera that is being set up, under the name that faults of it bear.
struct Subject {
  ArvCamera* camera;
  ArvDevice* device;
  const std::string& source;

  bool has(const char* feature) const { return has_feature(device, feature); }
  void set(const std::string& feature, const std::string& value) const { set_feature(device, feature, value, source); }
  [[noreturn]] void refuse(const std::string& operation, const std::string& reason, const std::string& remedy) const {
    throw CameraError(CameraTrouble::Refused, source, operation, reason, remedy);
  }
};

void set_region(const Subject& subject, const CameraRequest& request) {
  if (!request.offset && !request.size) return;
  if (request.size) {  // from the corner, where the largest size is allowed
    if (subject.has("OffsetX")) subject.set("OffsetX", "0");
    if (subject.has("OffsetY")) subject.set("OffsetY", "0");
    subject.set("Width", std::to_string(request.size->width));
    subject.set("Height", std::to_string(request.size->height));
  }
  if (request.offset) {
    subject.set("OffsetX", std::to_string(request.offset->x));
    subject.set("OffsetY", std::to_string(request.offset->y));
  }
}

PfncFormat set_pixel_format(const Subject& subject, const std::optional<std::string>& wanted) {
  if (wanted) subject.set("PixelFormat", *wanted);
  AravisFault fault;
  const auto code = static_cast<std::uint32_t>(arv_camera_get_pixel_format(subject.camera, fault.out()));
  fault.check(subject.source, "read PixelFormat");
  if (const auto format = pfnc_format(code)) return *format;
  std::vector<std::string> readable;
  for (const auto& name : enumeration_choices(subject.device, "PixelFormat")) {
    if (pfnc_format(name)) readable.push_back(name);
  }
  const char* const name = arv_camera_get_pixel_format_as_string(subject.camera, AravisFault().out());
  subject.refuse("choose the pixel format", fmt::format("{} cannot be read", name ? name : "its format"),
                 readable.empty() ? "use another camera" : fmt::format("ask for {}", fmt::join(readable, ", ")));
}

// The value of a quantity must lie within what the camera says of it.
struct Bounds {
  double least = 0, most = 0;
};

void check_bounds(const Subject& subject, const std::string& operation, double value, Bounds bounds,
                  const std::string& unit) {
  // Registers round: what the camera itself told as a bound is allowed.
  const double slack = 1e-6 * std::max(std::abs(bounds.least), std::abs(bounds.most));
  if (value >= bounds.least - slack && value <= bounds.most + slack) return;
  subject.refuse(operation, fmt::format("{:g} {} is out of range", value, unit),
                 fmt::format("it takes {:g} to {:g} {}", bounds.least, bounds.most, unit));
}

using GetBounds = void (*)(ArvCamera*, double*, double*, GError**);

Bounds bounds_of(const Subject& subject, const std::string& operation, GetBounds get) {
  AravisFault fault;
  Bounds bounds;
  get(subject.camera, &bounds.least, &bounds.most, fault.out());
  fault.check(subject.source, operation);
  return bounds;
}

void set_frame_rate(const Subject& subject, double fps_hz) {
  const std::string operation = "set the frame rate";
  check_bounds(subject, operation, fps_hz, bounds_of(subject, operation, arv_camera_get_frame_rate_bounds), "Hz");
  AravisFault fault;
  arv_camera_set_frame_rate(subject.camera, fps_hz, fault.out());
  fault.check(subject.source, operation);
}

void set_exposure(const Subject& subject, double exposure_s) {
  const std::string operation = "set the exposure";
  if (arv_camera_is_exposure_auto_available(subject.camera, AravisFault().out())) {
    arv_camera_set_exposure_time_auto(subject.camera, ARV_AUTO_OFF, AravisFault().out());
  }
  const double exposure_us = exposure_s * 1e6;
  check_bounds(subject, operation, exposure_us, bounds_of(subject, operation, arv_camera_get_exposure_time_bounds),
               "us");
  AravisFault fault;
  arv_camera_set_exposure_time(subject.camera, exposure_us, fault.out());
  fault.check(subject.source, operation);
}

void set_gain(const Subject& subject, double gain) {
  const std::string operation = "set the gain";
  if (arv_camera_is_gain_auto_available(subject.camera, AravisFault().out())) {
    arv_camera_set_gain_auto(subject.camera, ARV_AUTO_OFF, AravisFault().out());
  }
  check_bounds(subject, operation, gain, bounds_of(subject, operation, arv_camera_get_gain_bounds),
               "(the camera's unit)");
  AravisFault fault;
  arv_camera_set_gain(subject.camera, gain, fault.out());
  fault.check(subject.source, operation);
}

std::string hardware_source(const Subject& subject) {
  const char* const now = arv_camera_get_trigger_source(subject.camera, AravisFault().out());
  const auto is_hardware = [](const std::string& name) { return name.starts_with("Line"); };
  if (now && is_hardware(now)) return now;
  const auto choices = enumeration_choices(subject.device, "TriggerSource");
  const auto line = std::find_if(choices.begin(), choices.end(), is_hardware);
  if (line == choices.end()) {
    subject.refuse("set the hardware trigger", "the camera names no line for it", "set TriggerSource by its name");
  }
  return *line;
}

void set_trigger(const Subject& subject, const CameraRequest& request) {
  AravisFault fault;
  const auto is_of_trigger = [](const auto& setting) { return setting.first.starts_with("Trigger"); };
  const bool user_set_it = std::any_of(request.settings.begin(), request.settings.end(), is_of_trigger);
  switch (request.trigger) {
    case CameraTrigger::FreeRunning:
      if (!user_set_it && subject.has("TriggerMode")) arv_camera_clear_triggers(subject.camera, fault.out());
      break;
    case CameraTrigger::Software:
      if (!arv_camera_is_software_trigger_supported(subject.camera, AravisFault().out())) {
        subject.refuse("set the software trigger", "the camera has none", "leave it free-running");
      }
      arv_camera_set_trigger(subject.camera, "Software", fault.out());
      break;
    case CameraTrigger::Hardware:
      arv_camera_set_trigger(subject.camera, hardware_source(subject).c_str(), fault.out());
      break;
  }
  fault.check(subject.source, "set the trigger");
  for (const auto& setting : request.settings) {  // what was just overwritten, e.g. the edge
    if (is_of_trigger(setting)) subject.set(setting.first, setting.second);
  }
}

// Precision time, unless the user switched it off himself.
std::string set_clock(const Subject& subject, const CameraRequest& request) {
  for (const std::string name : {"GevIEEE1588", "PtpEnable"}) {
    if (!subject.has(name.c_str())) continue;
    const auto is_it = [&name](const auto& setting) { return setting.first == name; };
    if (std::none_of(request.settings.begin(), request.settings.end(), is_it)) {
      arv_device_set_boolean_feature_value(subject.device, name.c_str(), TRUE, AravisFault().out());
    }
    if (arv_device_get_boolean_feature_value(subject.device, name.c_str(), AravisFault().out())) return "PTP";
  }
  return "camera";
}

std::optional<std::chrono::nanoseconds> period_of(const Subject& subject, const CameraRequest& request) {
  const auto period = [](double fps_hz) {
    return fps_hz > 0 ? std::optional(std::chrono::nanoseconds(std::llround(1e9 / fps_hz))) : std::nullopt;
  };
  if (request.trigger == CameraTrigger::Hardware) return std::nullopt;
  AravisFault fault;
  if (request.trigger == CameraTrigger::Software && request.fps_hz) return period(*request.fps_hz);
  for (const char* const name : {"ResultingFrameRate", "AcquisitionResultingFrameRate", "ResultingFrameRateAbs"}) {
    if (!subject.has(name)) continue;
    const double fps_hz = arv_device_get_float_feature_value(subject.device, name, fault.out());
    if (!fault.happened()) return period(fps_hz);
  }
  if (!arv_camera_is_frame_rate_available(subject.camera, AravisFault().out())) return std::nullopt;
  const double fps_hz = arv_camera_get_frame_rate(subject.camera, fault.out());
  return fault.happened() ? std::nullopt : period(fps_hz);
}

std::optional<std::chrono::nanoseconds> exposure_of(const Subject& subject) {
  if (!arv_camera_is_exposure_time_available(subject.camera, AravisFault().out())) return std::nullopt;
  if (arv_camera_is_exposure_auto_available(subject.camera, AravisFault().out()) &&
      arv_camera_get_exposure_time_auto(subject.camera, AravisFault().out()) != ARV_AUTO_OFF) {
    return std::nullopt;
  }
  AravisFault fault;
  const double exposure_us = arv_camera_get_exposure_time(subject.camera, fault.out());
  if (fault.happened()) return std::nullopt;
  return std::chrono::nanoseconds(std::llround(1e3 * exposure_us));
}

std::string text_or_empty(const char* text) {
  return text ? text : "";
}

CameraFacts read_facts(const Subject& subject, const CameraRequest& request) {
  CameraFacts facts;
  facts.source = subject.source;
  facts.model = fmt::format("{} {}", text_or_empty(arv_camera_get_vendor_name(subject.camera, AravisFault().out())),
                            text_or_empty(arv_camera_get_model_name(subject.camera, AravisFault().out())));
  facts.serial = text_or_empty(arv_camera_get_device_serial_number(subject.camera, AravisFault().out()));
  AravisFault fault;
  int x = 0, y = 0;
  arv_camera_get_region(subject.camera, &x, &y, &facts.size.width, &facts.size.height, fault.out());
  fault.check(subject.source, "read its region");
  facts.device_format = text_or_empty(arv_camera_get_pixel_format_as_string(subject.camera, AravisFault().out()));
  facts.period = period_of(subject, request);
  facts.exposure = exposure_of(subject);
  facts.stamped = StampedMoment::ExposureStart;  // what makers of industrial cameras agree on
  return facts;
}

}  // namespace

CameraSetup set_up_camera(ArvCamera* camera, const CameraRequest& request, const std::string& source) {
  const Subject subject{camera, arv_camera_get_device(camera), source};
  arv_camera_stop_acquisition(camera, AravisFault().out());  // of a program that died
  for (const auto& [name, value] : request.settings) subject.set(name, value);
  set_region(subject, request);
  const PfncFormat wire = set_pixel_format(subject, request.pixel_format);
  if (request.fps_hz && request.trigger == CameraTrigger::FreeRunning) set_frame_rate(subject, *request.fps_hz);
  if (request.exposure_s) set_exposure(subject, *request.exposure_s);
  if (request.gain) set_gain(subject, *request.gain);
  set_trigger(subject, request);
  if (subject.has("AcquisitionMode")) subject.set("AcquisitionMode", "Continuous");
  const std::string clock = set_clock(subject, request);
  CameraSetup setup{read_facts(subject, request), wire};
  setup.facts.format = wire.format;
  setup.facts.clock = clock;
  return setup;
}

}  // namespace alidade
