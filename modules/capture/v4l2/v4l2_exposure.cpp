// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <linux/videodev2.h>

#include "capture/v4l2/v4l2_controls.h"

namespace alidade {
namespace {

constexpr double kExposureUnit_s = 1e-4;  // of V4L2_CID_EXPOSURE_ABSOLUTE

const V4l2Control* find(const std::vector<V4l2Control>& controls, std::uint32_t id) {
  const auto found = std::find_if(controls.begin(), controls.end(), [&](const auto& c) { return c.id == id; });
  return found == controls.end() ? nullptr : &*found;
}

bool offers(const V4l2Control& choice, std::int64_t value) {
  return std::any_of(choice.entries.begin(), choice.entries.end(), [&](const auto& e) { return e.first == value; });
}

}  // namespace

void set_v4l2_exposure(const V4l2Device& device, double exposure_s) {
  const std::vector<V4l2Control> controls = v4l2_controls(device);
  const V4l2Control* exposure = find(controls, V4L2_CID_EXPOSURE_ABSOLUTE);
  if (!exposure)
    throw v4l2_refusal(device.path(), "set the exposure", "the camera takes none in seconds",
                       find(controls, V4L2_CID_EXPOSURE) ? "set its own control 'exposure' instead" : "leave it out");
  const auto units = std::llround(exposure_s / kExposureUnit_s);
  if (units < exposure->least || units > exposure->most)
    throw v4l2_refusal(device.path(), "set the exposure", fmt::format("{} s is out of its range", exposure_s),
                       fmt::format("it takes {} to {} s", static_cast<double>(exposure->least) * kExposureUnit_s,
                                   static_cast<double>(exposure->most) * kExposureUnit_s));
  if (const V4l2Control* automatic = find(controls, V4L2_CID_EXPOSURE_AUTO))
    write_v4l2_control(
        device, *automatic,
        offers(*automatic, V4L2_EXPOSURE_MANUAL) ? V4L2_EXPOSURE_MANUAL : V4L2_EXPOSURE_SHUTTER_PRIORITY);
  write_v4l2_control(device, *exposure, units);
}

void set_v4l2_gain(const V4l2Device& device, double gain) {
  const std::vector<V4l2Control> controls = v4l2_controls(device);
  const V4l2Control* control = find(controls, V4L2_CID_GAIN);
  if (!control) control = find(controls, V4L2_CID_ANALOGUE_GAIN);
  if (!control) throw v4l2_refusal(device.path(), "set the gain", "the camera has none", "leave it out");
  const auto units = std::llround(gain);
  if (units < control->least || units > control->most)
    throw v4l2_refusal(device.path(), "set the gain", fmt::format("{} is out of its range", gain),
                       "it takes " + range_text(*control));
  if (const V4l2Control* automatic = find(controls, V4L2_CID_AUTOGAIN)) write_v4l2_control(device, *automatic, 0);
  write_v4l2_control(device, *control, units);
}

std::optional<std::chrono::nanoseconds> v4l2_exposure(const V4l2Device& device) {
  const auto automatic = read_v4l2_control(device, V4L2_CID_EXPOSURE_AUTO);
  if (automatic && *automatic != V4L2_EXPOSURE_MANUAL && *automatic != V4L2_EXPOSURE_SHUTTER_PRIORITY)
    return std::nullopt;
  const auto units = read_v4l2_control(device, V4L2_CID_EXPOSURE_ABSOLUTE);
  if (!units) return std::nullopt;
  return std::chrono::nanoseconds(std::llround(static_cast<double>(*units) * kExposureUnit_s * 1e9));
}

}  // namespace alidade
