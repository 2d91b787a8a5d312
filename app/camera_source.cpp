// SPDX-License-Identifier: Apache-2.0
#include "app/camera_source.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "app/frame_sources.h"
#include "core/errors.h"
#include "io/camera_file.h"

namespace alidade {
namespace {

Camera camera_for(const CameraSource& source, const std::filesystem::path& camera_file, const std::string& name,
                  ImageSize size) {
  if (!camera_file.empty()) {
    Camera camera = read_camera(camera_file, size);
    // Most camera files cannot say how long the shutter reads out; the data set may know its sensor.
    const bool dataset_knows = source.dataset && source.dataset->camera;
    if (camera.readout_s == 0 && dataset_knows) camera.readout_s = source.dataset->camera->readout_s;
    return camera;
  }
  if (source.dataset && source.dataset->camera) return *source.dataset->camera;
  throw InputError(name, 0, "the camera that took these images is not known",
                   "give its file with --camera, or make one with 'alidade calibrate camera'");
}

ImageFrame as_image_frame(Frame frame) {
  ImageFrame image;
  image.index = frame.index;
  image.time = frame.time;
  image.name = std::move(frame.name);
  if (frame.image.channels() == 3) {
    cv::cvtColor(frame.image, image.grey, cv::COLOR_BGR2GRAY);
    image.colour = std::move(frame.image);
  } else {
    image.grey = std::move(frame.image);
  }
  return image;
}

}  // namespace

CameraSource open_camera_source(const std::string& name, const std::filesystem::path& camera_file,
                                std::optional<double> fps_hz, const LiveRequest& live) {
  CameraSource source;
  source.is_live = is_camera_name(name);
  if (std::filesystem::is_directory(name)) source.dataset = open_dataset(name);
  source.frames =
      source.dataset && !fps_hz ? open_frames(*source.dataset) : open_frames(name, live.options, live.events, fps_hz);
  if (!camera_file.empty()) read_camera(camera_file, ImageSize{1 << 20, 1 << 20});  // its own faults come first
  source.first = source.frames->next();
  if (!source.first) throw InputError(name, 0, "holds no image that can be read", "give a folder, glob or video");
  const ImageSize size{source.first->image.cols, source.first->image.rows};
  source.camera = camera_for(source, camera_file, name, size);
  if (source.camera.width != size.width || source.camera.height != size.height) {
    throw InputError(camera_file.empty() ? name : camera_file.string(), 0,
                     fmt::format("the camera is for {}x{} px, the images of {} have {}x{}", source.camera.width,
                                 source.camera.height, name, size.width, size.height),
                     "calibrate at the size of the images, or give images of the camera's size");
  }
  return source;
}

std::optional<ImageFrame> next_image(CameraSource& source, std::stop_token stop) {
  std::optional<Frame> frame = source.first ? std::exchange(source.first, std::nullopt) : source.frames->next(stop);
  if (!frame) return std::nullopt;
  source.stamp = frame->stamp;
  return as_image_frame(std::move(*frame));
}

}  // namespace alidade
