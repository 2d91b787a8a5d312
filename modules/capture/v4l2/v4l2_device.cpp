// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_device.h"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace alidade {
namespace {

CameraTrouble trouble_of(int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
    case EIO:
    case EPIPE:
    case EPROTO:
    case ESHUTDOWN:
    case ETIMEDOUT:
      return CameraTrouble::Gone;
    case EBUSY:
      return CameraTrouble::Busy;
    case EACCES:
    case EPERM:
      return CameraTrouble::Denied;
    default:
      return CameraTrouble::Refused;
  }
}

std::string reason_of(int error) {
  switch (error) {
    case ENOENT:
      return "no such device";
    case ENODEV:
    case ENXIO:
      return "the device is gone";
    case EBUSY:
      return "in use by another program";
    case ENOSPC:
      return "not enough room on its bus";
    default:
      return std::generic_category().message(error);
  }
}

std::string remedy_of(int error) {
  switch (error) {
    case ENOSPC:
      return "use another USB port, a smaller size, a lower rate or MJPG";
    case EBUSY:
      return "close the other program ('fuser -v DEVICE' names it)";
    case EACCES:
    case EPERM:
      return "become a member of the group 'video': sudo usermod -aG video $USER, then log in anew";
    case ENOENT:
      return "'alidade devices' lists the cameras";
    default:
      return trouble_of(error) == CameraTrouble::Gone ? "is it plugged in?" : "";
  }
}

int open_node(const std::string& path) {
  const int number = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (number < 0) throw v4l2_error(path, "open", errno);
  return number;
}

std::string text_of(const __u8* bytes, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  return text.substr(0, text.find('\0'));
}

V4l2Identity identity_of(const v4l2_capability& told) {
  const std::uint32_t can = told.capabilities & V4L2_CAP_DEVICE_CAPS ? told.device_caps : told.capabilities;
  V4l2Identity identity{text_of(told.driver, sizeof told.driver), text_of(told.card, sizeof told.card),
                        text_of(told.bus_info, sizeof told.bus_info)};
  identity.can_capture = (can & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) && (can & V4L2_CAP_STREAMING);
  identity.is_multiplanar = !(can & V4L2_CAP_VIDEO_CAPTURE) && (can & V4L2_CAP_VIDEO_CAPTURE_MPLANE);
  identity.buffer_type = identity.is_multiplanar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
  return identity;
}

}  // namespace

CameraError v4l2_error(const std::string& path, const std::string& operation, int error) {
  return {trouble_of(error), path, operation, reason_of(error), remedy_of(error)};
}

CameraError v4l2_refusal(const std::string& path, const std::string& operation, const std::string& reason,
                         const std::string& remedy) {
  return {CameraTrouble::Refused, path, operation, reason, remedy};
}

Descriptor::~Descriptor() {
  close(number_);
}

V4l2Device::V4l2Device(std::string path) : path_(std::move(path)), descriptor_(open_node(path_)) {
  v4l2_capability told{};
  const int error = call(VIDIOC_QUERYCAP, &told);
  if (error == ENOTTY || error == EINVAL)
    throw v4l2_refusal(path_, "open", "this is no camera", "'alidade devices' lists the cameras");
  if (error != 0) throw v4l2_error(path_, "open", error);
  identity_ = identity_of(told);
}

int V4l2Device::call(unsigned long request, void* argument) const {
  int result = 0;
  do {
    result = ioctl(descriptor_.number(), request, argument);
  } while (result < 0 && errno == EINTR);
  return result < 0 ? errno : 0;
}

void V4l2Device::require(unsigned long request, void* argument, const std::string& operation) const {
  if (const int error = call(request, argument)) throw v4l2_error(path_, operation, error);
}

}  // namespace alidade
