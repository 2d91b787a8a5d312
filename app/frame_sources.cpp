// SPDX-License-Identifier: Apache-2.0
#include "app/frame_sources.h"

#include <utility>

#include "capture/decoding.h"
#include "capture/file_sources.h"
#include "capture/frame_queue.h"
#include "capture/genicam/genicam_camera.h"
#include "capture/live_camera.h"
#include "capture/v4l2/v4l2_camera.h"
#include "core/errors.h"

namespace alidade {
namespace {

constexpr std::string_view kV4l2 = "v4l2:", kGenicam = "genicam:", kDevice = "/dev/";

// Of a live view: a frame under work, one waiting, one for the case that the work takes a little longer.
constexpr std::size_t kLiveFrames = 2;

}  // namespace

bool is_camera_name(const std::string& source) {
  return source.starts_with(kV4l2) || source.starts_with(kGenicam) || source.starts_with(kDevice);
}

CameraOpener camera_opener(const std::string& source, const CameraRequest& request) {
  if (source.starts_with(kV4l2)) {
    return [path = source.substr(kV4l2.size()), request] { return open_v4l2(path, request); };
  }
  if (source.starts_with(kDevice)) {
    return [source, request] { return open_v4l2(source, request); };
  }
  if (source.starts_with(kGenicam)) {
    return [id = source.substr(kGenicam.size()), request] { return open_genicam(id, request); };
  }
  throw InputError(source, 0, "is not a camera",
                   "name it like v4l2:/dev/video0 or genicam:192.168.0.7; 'alidade devices' lists them");
}

std::unique_ptr<FrameSource> open_frames(const std::string& source, const CameraOptions& options,
                                         CaptureEventSink events, std::optional<double> fps_hz) {
  if (!is_camera_name(source)) return open_files(source, fps_hz);
  auto camera = open_live_camera(source, camera_opener(source, request_of(options)), live_options_of(options), events);
  return decoded(queued(std::move(camera), {kLiveFrames, WhenFull::DropOldest, events}));
}

}  // namespace alidade
