// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/options_yaml.h"
#include "capture/camera_device.h"
#include "capture/live_camera.h"

namespace alidade {

/// What the user asks of a camera; empty or 0: as the camera has it.
struct CameraOptions {
  std::string size;          ///< "640x480", px
  std::string offset;        ///< "16,8", px
  std::string pixel_format;  ///< the device's own name
  double rate_hz = 0;
  double exposure_ms = 0;
  std::string gain;     ///< a number; text, since 0 is one
  int packet_size = 0;  ///< bytes
  CameraTrigger trigger = CameraTrigger::FreeRunning;
  double give_up_s = 0;  ///< 0: never
  /// Controls and features, "NAME=VALUE", or "CAMERA:NAME=VALUE" for one of several.
  std::vector<std::string> settings;
};

/// Binds all but the settings, under "camera."; the settings become the flag --set.
void bind(OptionFields& fields, CLI::App& flags, CameraOptions& options);

/// Throws std::invalid_argument naming field, value and what was wanted.
void validate(const CameraOptions& options);

/// What to ask of the camera `name`; settings that name another are left out.
CameraRequest request_of(const CameraOptions& options, const std::string& name = "");

LiveCameraOptions live_options_of(const CameraOptions& options);

}  // namespace alidade
