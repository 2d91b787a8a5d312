// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core/types.hpp>

#include "capture/frame_source.h"
#include "core/errors.h"

namespace alidade {

/// When a camera exposes.
enum class CameraTrigger {
  FreeRunning,
  Software,  ///< when the host says so: at the multiples of the frame period on the host's clock, so that all cameras
             ///< of one rate expose together
  Hardware,  ///< when a signal comes in at the camera
};

/// What the user wants of a camera; what is empty stays as the camera has it.
struct CameraRequest {
  std::optional<cv::Point> offset{};  ///< px, of the region on the sensor
  std::optional<cv::Size> size{};     ///< px
  std::optional<std::string>
      pixel_format;  ///< the device's own name of it: V4L2's four characters ("YUYV"), GenICam's ("Mono12Packed")
  std::optional<double> fps_hz{};
  std::optional<double> exposure_s{};  ///< also switches an automatic exposure off
  std::optional<double> gain{};  ///< in the device's own unit (GenICam: dB, often); also switches an automatic gain off
  std::optional<int> packet_size{};  ///< bytes, GigE Vision; else the largest that comes through
  CameraTrigger trigger = CameraTrigger::FreeRunning;
  std::vector<std::pair<std::string, std::string>>
      settings;  ///< controls or features by name, in this order, before all others
};

/// What a device's stamp on a frame means.
enum class StampedMoment { Unknown, ExposureStart, ReadoutEnd };

/// What an opened camera granted.
struct CameraFacts {
  std::string source;  ///< as one names it on the command line, in its most lasting form: "v4l2:/dev/v4l/by-id/..."
  std::string model;   ///< maker and model
  std::string serial;  ///< empty where it has none
  cv::Size size;       ///< px
  PixelFormat format;
  std::string device_format;                           ///< the device's own name of it
  std::optional<std::chrono::nanoseconds> period{};    ///< between two frames; empty where a trigger sets it
  std::optional<std::chrono::nanoseconds> exposure{};  ///< empty where it is automatic or not told
  std::string clock;           ///< of CaptureStamp::device_time: "host monotonic", "camera", "PTP", ...
  bool is_host_clock = false;  ///< device_time is on HostClock's time scale
  StampedMoment stamped = StampedMoment::Unknown;
};

/// From a frame's device_time to the middle of its exposure, as far as that is known: 0 where it is not.
std::chrono::nanoseconds stamp_to_middle(const CameraFacts& facts);

/// Why a camera cannot be used, for those who decide whether to try again.
enum class CameraTrouble {
  Gone,     ///< unplugged, switched off, no answer
  Busy,     ///< another program has it
  Denied,   ///< no permission
  Refused,  ///< it is there, but is no camera or does not do what is asked
};

/// A DeviceError of a camera.
class CameraError : public DeviceError {
 public:
  CameraError(CameraTrouble trouble, std::string device, std::string operation, std::string reason, std::string remedy)
      : DeviceError(std::move(device), std::move(operation), std::move(reason), std::move(remedy)), trouble_(trouble) {}

  CameraTrouble trouble() const { return trouble_; }

 private:
  CameraTrouble trouble_;
};

/// A camera that streams from construction to destruction, driven by one thread. It knows nothing of stalls and never
/// opens itself again; LiveCamera does both.
class CameraDevice {
 public:
  virtual ~CameraDevice() = default;

  virtual const CameraFacts& facts() const = 0;

  /// The next frame, with index, name and dropped_before left at their defaults and `time` as device_time (LiveCamera
  /// sets these); empty where none came within `timeout`. A damaged frame is given too, and says so; where its content
  /// has not even the right length its image is empty. Throws CameraError (Gone) once the device is lost.
  virtual std::optional<Frame> wait(std::chrono::nanoseconds timeout) = 0;

  /// What the device counts of its own troubles, for the record: {"resent packets", 12}. Empty for most.
  virtual std::vector<std::pair<std::string, std::uint64_t>> statistics() const { return {}; }
};

/// Opens the camera, each time anew. Throws CameraError.
using CameraOpener = std::function<std::unique_ptr<CameraDevice>()>;

}  // namespace alidade
