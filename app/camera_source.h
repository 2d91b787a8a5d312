// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "app/camera_options.h"
#include "camera/camera.h"
#include "capture/capture_event.h"
#include "capture/frame_source.h"
#include "datasets/dataset.h"
#include "tracking/frame.h"

namespace alidade {

/// What the user named as SOURCE and --camera, opened: the frames in order, the camera that took them, and the data
/// set's other knowledge where SOURCE is one.
struct CameraSource {
  std::unique_ptr<FrameSource> frames;
  Camera camera;
  std::optional<Dataset> dataset;
  std::optional<Frame> first;  ///< already taken from `frames`, to see the size of the images
  bool is_live = false;        ///< frames come when the camera takes them, without end
  CaptureStamp stamp{};        ///< of the frame that next_image gave last
};

/// What a live camera is asked for, and who is told of its troubles.
struct LiveRequest {
  CameraOptions options;
  CaptureEventSink events;  ///< may be empty
};

/// Opens SOURCE (data set folder, video, folder or glob of images, live camera) with the camera of `camera_file`, or
/// the data set's own where that is empty. Throws InputError where either cannot be read, there is no camera, or it is
/// a camera for images of another size.
CameraSource open_camera_source(const std::string& source, const std::filesystem::path& camera_file,
                                std::optional<double> fps_hz, const LiveRequest& live = {});

/// The next frame as the tracker takes it, `first` before the others; empty at the end, and soon after a stop is
/// requested.
std::optional<ImageFrame> next_image(CameraSource& source, std::stop_token stop = {});

}  // namespace alidade
