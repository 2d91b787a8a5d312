// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/camera_options.h"
#include "capture/capture_event.h"
#include "capture/frame_source.h"

namespace alidade {

/// Whether SOURCE names a live camera: "v4l2:/dev/video0", "/dev/video0", "genicam:192.168.0.7".
bool is_camera_name(const std::string& source);

/// Opens, and opens again, the camera of that name. Throws InputError where it names no camera, or none that this
/// program knows.
CameraOpener camera_opener(const std::string& source, const CameraRequest& request);

/// What the user names as SOURCE, for a method that looks at frames: decoded, files in order, of a live camera the
/// newest, in a thread of its own. `fps_hz`: of images that have no times. `events` may be empty.
std::unique_ptr<FrameSource> open_frames(const std::string& source, const CameraOptions& options,
                                         CaptureEventSink events, std::optional<double> fps_hz = std::nullopt);

}  // namespace alidade
