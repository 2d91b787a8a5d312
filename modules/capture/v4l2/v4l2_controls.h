// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "capture/camera_listing.h"
#include "capture/v4l2/v4l2_control.h"
#include "capture/v4l2/v4l2_device.h"

namespace alidade {

/// The controls of a device, in its order; of those with several values (matrices) none.
std::vector<V4l2Control> v4l2_controls(const V4l2Device& device);

/// The value now; empty where it cannot be read, and for texts.
std::optional<std::int64_t> read_v4l2_control(const V4l2Device& device, std::uint32_t id);

/// Throws CameraError where the driver does not take it.
void write_v4l2_control(const V4l2Device& device, const V4l2Control& control, std::int64_t value);

/// Sets the control of that name; parse_v4l2_value says what `text` may be. Throws CameraError.
void set_v4l2_control(const V4l2Device& device, std::string_view name, std::string_view text);

/// The controls for a list of cameras, with their values.
std::vector<ListedControl> list_v4l2_controls(const V4l2Device& device);

}  // namespace alidade
