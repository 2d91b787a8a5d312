// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "camera/camera.h"
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
  CaptureStamp stamp{};        ///< of the frame that next_image gave last
};

/// Opens SOURCE (data set folder, video, folder or glob of images) with the camera of `camera_file`, or the data set's
/// own where that is empty. Throws InputError where either cannot be read, there is no camera, or it is a camera for
/// images of another size.
CameraSource open_camera_source(const std::string& source, const std::filesystem::path& camera_file,
                                std::optional<double> fps_hz);

/// The next frame as the tracker takes it, `first` before the others; empty at the end.
std::optional<ImageFrame> next_image(CameraSource& source);

}  // namespace alidade
