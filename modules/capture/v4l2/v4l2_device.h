// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "capture/camera_device.h"

namespace alidade {

/// What a system call on the device `path` failed with, and what may be done about it.
CameraError v4l2_error(const std::string& path, const std::string& operation, int error);

/// A CameraError (Refused): the device is there, and does not do what is asked.
CameraError v4l2_refusal(const std::string& path, const std::string& operation, const std::string& reason,
                         const std::string& remedy);

/// A file descriptor, closed with its owner.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor();
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }

 private:
  int number_;
};

/// What a device says of itself.
struct V4l2Identity {
  std::string driver, model, bus;
  bool can_capture = false;       ///< video, by streaming
  bool is_multiplanar = false;    ///< each plane of an image may lie in memory of its own
  std::uint32_t buffer_type = 0;  ///< V4L2_BUF_TYPE_VIDEO_CAPTURE or its multi-planar sister
};

/// An open V4L2 device node. Calls do not block.
class V4l2Device {
 public:
  /// Throws CameraError: no such device, no permission, no V4L2 device.
  explicit V4l2Device(std::string path);

  const std::string& path() const { return path_; }
  const V4l2Identity& identity() const { return identity_; }
  int descriptor() const { return descriptor_.number(); }

  /// ioctl, repeated while a signal interrupts it: 0, or the error number.
  int call(unsigned long request, void* argument) const;

  /// The same; throws v4l2_error where it fails. `operation` says in words what was tried.
  void require(unsigned long request, void* argument, const std::string& operation) const;

 private:
  std::string path_;
  Descriptor descriptor_;
  V4l2Identity identity_;
};

}  // namespace alidade
