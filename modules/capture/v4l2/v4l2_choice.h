// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <linux/videodev2.h>

#include "capture/v4l2/v4l2_formats.h"
#include "capture/v4l2/v4l2_offers.h"

namespace alidade {

/// A format that a device offers at the wanted size.
struct V4l2Candidate {
  const V4l2Format* format = nullptr;
  V4l2Periods periods;  ///< where the driver tells none, any rate is believed
};

/// The candidate to take: the first in the order of v4l2_formats() that reaches `fps_hz` (without one: 30 Hz, or what
/// the fastest reaches if that is less), so that what is free of loss goes before JPEG unless only JPEG is fast enough;
/// where none reaches it, the fastest. Null where there is none.
const V4l2Candidate* preferred(std::span<const V4l2Candidate> candidates, std::optional<double> fps_hz);

/// The offered period that is nearest to `fps_hz` in rate; of a range, or where none is offered, that rate itself.
v4l2_fract nearest_period(const V4l2Periods& offered, double fps_hz);

}  // namespace alidade
