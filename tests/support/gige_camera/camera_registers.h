// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

#include <opencv2/core/types.hpp>

#include "tests/support/gige_camera/gvcp_message.h"
#include "tests/support/gige_camera/payload_format.h"

namespace alidade::test {

/// Where the features lie. Below 0x10000 as GigE Vision has it ("bootstrap registers").
namespace address {
constexpr std::uint32_t kHeartbeatTimeout = 0x938;  ///< ms
constexpr std::uint32_t kTimestampControl = 0x944;  ///< 2: latch
constexpr std::uint32_t kTimestampLatched = 0x948;  ///< 8 bytes
constexpr std::uint32_t kControlPrivilege = 0xa00;
constexpr std::uint32_t kStreamPort = 0xd00;
constexpr std::uint32_t kStreamPacketSize = 0xd04;
constexpr std::uint32_t kStreamDestination = 0xd18;
constexpr std::uint32_t kStreamSourcePort = 0xd1c;
constexpr std::uint32_t kWidth = 0x10100;
constexpr std::uint32_t kHeight = 0x10104;
constexpr std::uint32_t kOffsetX = 0x10108;
constexpr std::uint32_t kOffsetY = 0x1010c;
constexpr std::uint32_t kPixelFormat = 0x10110;
constexpr std::uint32_t kSensorWidth = 0x10114;
constexpr std::uint32_t kSensorHeight = 0x10118;
constexpr std::uint32_t kPayloadSize = 0x1011c;
constexpr std::uint32_t kAcquisitionMode = 0x10120;
constexpr std::uint32_t kAcquisitionStart = 0x10124;
constexpr std::uint32_t kAcquisitionStop = 0x10128;
constexpr std::uint32_t kFrameRateEnable = 0x1012c;
constexpr std::uint32_t kFrameRate = 0x10130;     ///< 8 bytes, Hz
constexpr std::uint32_t kExposureTime = 0x10138;  ///< 8 bytes, µs
constexpr std::uint32_t kExposureAuto = 0x10140;
constexpr std::uint32_t kGainAuto = 0x10144;
constexpr std::uint32_t kGain = 0x10148;  ///< 8 bytes, dB
constexpr std::uint32_t kTriggerMode = 0x10150;
constexpr std::uint32_t kTriggerSource = 0x10154;
constexpr std::uint32_t kTriggerSoftware = 0x10158;
constexpr std::uint32_t kTriggerSelector = 0x1015c;
constexpr std::uint32_t kTriggerActivation = 0x10160;
constexpr std::uint32_t kDescription = 0x20000;  ///< the GenICam description
}  // namespace address

/// Bounds that the description states and the registers hold.
constexpr double kLeastFps = 0.1;
constexpr double kMostFps = 100000;
constexpr double kLeastExposureUs = 1;
constexpr double kMostExposureUs = 1e7;
constexpr double kMostGainDb = 24;
constexpr std::uint32_t kLeastPacketSize = 576;
constexpr std::uint32_t kMostPacketSize = 65500;  ///< of what loopback carries unbroken, 65535

/// What a camera is before anyone asks anything of it.
struct CameraSetup {
  std::string address = "127.0.0.1";
  std::string serial = "ALIDADE1";
  cv::Size sensor{2048, 2048};  ///< px
  cv::Size size{512, 512};      ///< px, of the first region
  PayloadFormat format = *find_payload_format("Mono8");
  double fps_hz = 30;
  std::chrono::microseconds exposure{3000};
  bool is_exposure_automatic = false;
};

/// What the registers say of the pictures to take.
struct AcquisitionSettings {
  cv::Rect region;  ///< px, on the sensor
  PayloadFormat format;
  std::chrono::nanoseconds period{};  ///< 0: as fast as it goes
  std::chrono::nanoseconds exposure{};
  bool is_triggered = false;
  bool is_single = false;  ///< one frame, then it stops
};

/// Where the stream goes.
struct StreamTarget {
  std::uint32_t address = 0;         ///< IPv4, as a number
  std::uint16_t port = 0;            ///< 0: nowhere
  std::uint32_t packet_size = 1500;  ///< bytes, with the headers of IP and UDP
};

/// The memory of the camera. For several threads at once.
class CameraRegisters {
 public:
  explicit CameraRegisters(const CameraSetup& setup);

  /// `size` bytes from `from` on; empty where there are none.
  Bytes read(std::uint32_t from, std::size_t size) const;

  /// Writes a feature, if it takes the value.
  GvcpStatus write(std::uint32_t to, std::span<const std::uint8_t> value);

  std::uint32_t word(std::uint32_t from) const;
  void set_word(std::uint32_t to, std::uint32_t value);
  void set_timestamp(std::uint64_t ticks);

  AcquisitionSettings acquisition() const;
  StreamTarget stream_target() const;
  bool is_trigger_software() const;

 private:
  std::uint32_t word_at(std::uint32_t from) const;
  double real_at(std::uint32_t from) const;
  void put_word(std::uint32_t to, std::uint32_t value);
  void put_real(std::uint32_t to, double value);
  void put_text(std::uint32_t to, const std::string& text, std::size_t size);
  void fill_bootstrap(const CameraSetup& setup);
  void fill_features(const CameraSetup& setup);
  GvcpStatus check(std::uint32_t to, std::span<const std::uint8_t> value) const;
  void update_payload_size();

  mutable std::mutex mutex_;
  Bytes memory_;
};

}  // namespace alidade::test
