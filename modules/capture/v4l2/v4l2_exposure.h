// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>

#include "capture/v4l2/v4l2_device.h"

namespace alidade {

/// Sets the exposure time by the control exposure_time_absolute, to 0.1 ms as that counts, and switches an automatic
/// exposure off. Throws CameraError (Refused) naming the range, or that the camera has no such control.
void set_v4l2_exposure(const V4l2Device& device, double exposure_s);

/// Sets the gain, in the camera's unit, by the control gain or analogue_gain, and switches an automatic gain off.
/// Throws CameraError.
void set_v4l2_gain(const V4l2Device& device, double gain);

/// The exposure time; empty where it is automatic or the camera does not tell.
std::optional<std::chrono::nanoseconds> v4l2_exposure(const V4l2Device& device);

}  // namespace alidade
