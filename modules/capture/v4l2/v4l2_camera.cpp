// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_camera.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <utility>

#include <linux/videodev2.h>
#include <poll.h>

#include "capture/v4l2/v4l2_controls.h"
#include "capture/v4l2/v4l2_exposure.h"
#include "capture/v4l2/v4l2_names.h"
#include "capture/v4l2/v4l2_negotiation.h"
#include "capture/v4l2/v4l2_pixels.h"
#include "capture/v4l2/v4l2_stream.h"

namespace alidade {
namespace {

/// Refuses what V4L2 has no word for.
void check(const std::string& path, const CameraRequest& request) {
  if (request.trigger != CameraTrigger::FreeRunning)
    throw v4l2_refusal(path, "set the trigger", "V4L2 has none", "leave it out; some cameras have a control for it");
  if (request.packet_size) throw v4l2_refusal(path, "set the packet size", "V4L2 has none", "leave it out");
}

/// So many that a reader who is held up for 0.1 s misses nothing.
int buffer_count(std::optional<std::chrono::nanoseconds> period) {
  constexpr double kHeldUp_s = 0.1;
  const double frames = period ? kHeldUp_s / std::chrono::duration<double>(*period).count() : 0;
  return std::clamp(static_cast<int>(std::ceil(frames)) + 2, 4, 32);
}

StampedMoment moment_of(std::uint32_t flags) {
  switch (flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) {
    case V4L2_BUF_FLAG_TSTAMP_SRC_SOE:
      return StampedMoment::ExposureStart;
    case V4L2_BUF_FLAG_TSTAMP_SRC_EOF:
      return StampedMoment::ReadoutEnd;
    default:
      return StampedMoment::Unknown;
  }
}

std::string lasting_source(const std::string& path) {
  const auto names = lasting_names(path);
  return "v4l2:" + (names.empty() ? path : names.front().string());
}

CameraFacts facts_of(const V4l2Device& device, const V4l2Grant& grant, std::uint32_t buffer_flags) {
  CameraFacts facts;
  facts.source = lasting_source(device.path());
  facts.model = device.identity().model;
  facts.serial = usb_serial(device.path());
  facts.size = grant.size;
  facts.format = grant.format->pixels;
  facts.device_format = v4l2_format_name(grant.format->code);
  facts.period = grant.period;
  facts.exposure = v4l2_exposure(device);
  facts.is_host_clock = (buffer_flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  facts.clock = facts.is_host_clock ? "host monotonic" : "driver";
  facts.stamped = moment_of(buffer_flags);
  return facts;
}

class V4l2Camera : public CameraDevice {
 public:
  V4l2Camera(const std::string& path, const CameraRequest& request)
      : device_(path),
        grant_(set_up(device_, request)),
        stream_(device_, buffer_count(grant_.period)),
        facts_(facts_of(device_, grant_, stream_.flags())) {}

  const CameraFacts& facts() const override { return facts_; }
  std::optional<Frame> wait(std::chrono::nanoseconds timeout) override;

 private:
  static V4l2Grant set_up(const V4l2Device& device, const CameraRequest& request);
  bool is_ready(HostTime end) const;
  Frame frame_of(const V4l2Filled& filled);

  V4l2Device device_;
  V4l2Grant grant_;
  V4l2Stream stream_;
  CameraFacts facts_;
};

V4l2Grant V4l2Camera::set_up(const V4l2Device& device, const CameraRequest& request) {
  if (!device.identity().can_capture)
    throw v4l2_refusal(device.path(), "open", "it does not capture video", "'alidade devices' lists the cameras");
  check(device.path(), request);
  require_idle(device);  // before its controls change under another program
  for (const auto& [name, value] : request.settings) set_v4l2_control(device, name, value);
  V4l2Grant grant = negotiate(device, request);
  if (request.exposure_s) set_v4l2_exposure(device, *request.exposure_s);
  if (request.gain) set_v4l2_gain(device, *request.gain);
  return grant;
}

/// Whether the device has something to say before `end`.
bool V4l2Camera::is_ready(HostTime end) const {
  while (true) {
    const auto left = std::max(std::chrono::nanoseconds(0), std::chrono::nanoseconds(end - HostClock::now()));
    const timespec limit{std::chrono::duration_cast<std::chrono::seconds>(left).count(),
                         (left % std::chrono::seconds(1)).count()};
    pollfd waiting{device_.descriptor(), POLLIN, 0};
    const int ready = ppoll(&waiting, 1, &limit, nullptr);
    if (ready >= 0) return ready > 0;
    if (errno != EINTR) throw v4l2_error(device_.path(), "wait for a frame", errno);
  }
}

std::optional<Frame> V4l2Camera::wait(std::chrono::nanoseconds timeout) {
  auto filled = stream_.take();
  if (!filled) {
    if (!is_ready(HostClock::now() + timeout)) return std::nullopt;
    filled = stream_.take();  // says what is wrong, if that is what the device had to say
  }
  if (!filled) throw v4l2_error(device_.path(), "wait for a frame", EIO);
  Frame frame = frame_of(*filled);
  stream_.give_back(filled->index);
  return frame;
}

Frame V4l2Camera::frame_of(const V4l2Filled& filled) {
  Frame frame;
  frame.time = Timestamp(filled.time);
  frame.format = grant_.format->pixels;
  frame.stamp.device_time = frame.time;
  frame.stamp.host_time = HostClock::now();
  frame.stamp.sequence = filled.sequence;
  std::vector<V4l2Plane> planes;
  for (std::size_t i = 0; i < filled.planes.size(); ++i)
    planes.push_back({filled.planes[i], i < grant_.strides.size() ? grant_.strides[i] : 0});
  frame.image = v4l2_image(planes, *grant_.format, grant_.size);
  frame.stamp.is_damaged = (filled.flags & V4L2_BUF_FLAG_ERROR) || frame.image.empty();
  return frame;
}

}  // namespace

std::unique_ptr<CameraDevice> open_v4l2(const std::string& path, const CameraRequest& request) {
  return std::make_unique<V4l2Camera>(path, request);
}

}  // namespace alidade
