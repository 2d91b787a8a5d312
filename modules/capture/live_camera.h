// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "capture/camera_device.h"
#include "capture/capture_event.h"
#include "capture/frame_source.h"

namespace alidade {

/// When a camera counts as stalled or lost, and what is done about it.
struct LiveCameraOptions {
  /// Frame periods without a frame that make a stall, but at least least_stall_s: by then a frame is not merely late.
  double stall_periods = 4;
  double least_stall_s = 0.1;
  double first_frame_s = 2;   ///< allowed on top of that for the first frame after opening: some cameras wake slowly
  double reopen_after_s = 1;  ///< of a stall: then the camera is closed and opened anew
  double retry_s = 0.2;       ///< between two attempts to open
  std::optional<double> give_up_s{};  ///< without a frame: then next() throws; empty: never
  bool is_triggered = false;          ///< frames come when a signal does: silence is no fault
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const LiveCameraOptions& options);

/// A camera that comes back: its frames in order, with index, name, time, and frames dropped by the device counted;
/// every fault is told to `events` as it happens, and the camera is opened again after a loss. The first opening
/// happens here, and throws what `open` throws. `name`: as the user named it.
/// Frame::time is the host's clock, mid-exposure where the exposure is known (ClockOffset for cameras with a clock of
/// their own).
std::unique_ptr<FrameSource> open_live_camera(std::string name, CameraOpener open, const LiveCameraOptions& options,
                                              CaptureEventSink events);

}  // namespace alidade
