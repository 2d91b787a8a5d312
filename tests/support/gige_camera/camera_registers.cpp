// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/camera_registers.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <numeric>

#include <arpa/inet.h>
#include <fmt/format.h>

#include "tests/support/gige_camera/camera_description.h"

namespace alidade::test {
namespace {

constexpr std::size_t kMemorySize = 0x40000;
constexpr std::uint32_t kPacketSizeMask = 0x0000ffff;
constexpr std::uint32_t kFireTestPacket = 1U << 31U;
constexpr std::uint64_t kTicksPerSecond = 1'000'000'000;

// What GigE Vision calls a capability.
constexpr std::uint32_t kWriteMemory = 1U << 1U;
constexpr std::uint32_t kPacketResend = 1U << 2U;
constexpr std::uint32_t kSerialNumber = 1U << 30U;

bool is_any_of(std::uint32_t value, std::initializer_list<std::uint32_t> values) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

bool is_real(std::uint32_t at) {
  return is_any_of(at, {address::kFrameRate, address::kExposureTime, address::kGain});
}

bool is_read_only(std::uint32_t at) {
  const bool is_identity = at < address::kHeartbeatTimeout;
  const bool is_description = at >= address::kDescription;
  return is_identity || is_description ||
         is_any_of(at, {address::kTimestampLatched, address::kStreamSourcePort, address::kSensorWidth,
                        address::kSensorHeight, address::kPayloadSize});
}

GvcpStatus require(bool is_allowed) {
  return is_allowed ? GvcpStatus::Success : GvcpStatus::InvalidParameter;
}

std::chrono::nanoseconds from_us(double us) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(us * 1e3 + 0.5));
}

}  // namespace

CameraRegisters::CameraRegisters(const CameraSetup& setup) : memory_(kMemorySize) {
  fill_bootstrap(setup);
  fill_features(setup);
}

void CameraRegisters::fill_bootstrap(const CameraSetup& setup) {
  put_word(0x0, 0x00010002);  // GigE Vision 1.2
  put_word(0x4, 0x80000001);  // big-endian, UTF-8
  in_addr own{};
  inet_pton(AF_INET, setup.address.c_str(), &own);
  const std::uint32_t ip = ntohl(own.s_addr);
  put_word(0x8, 0x00000200);  // a MAC address, administered locally, made from the other
  put_word(0xc, ip);
  put_word(0x10, 0x80000007);
  put_word(0x14, 0x00000001);
  put_word(0x24, ip);
  put_word(0x34, 0xff000000);
  put_text(0x48, "Alidade", 32);
  put_text(0x68, "TestCamera", 32);
  put_text(0x88, "1.0", 32);
  put_text(0xd8, setup.serial, 16);
  const std::string description = camera_description(setup.sensor);
  put_text(0x200, fmt::format("Local:alidade.xml;{:x};{:x}", address::kDescription, description.size()), 512);
  put_text(address::kDescription, description, kMemorySize - address::kDescription);
  put_word(0x600, 1);  // network interfaces
  put_word(0x904, 1);  // stream channels
  put_word(0x934, kWriteMemory | kPacketResend | kSerialNumber);
  put_word(address::kHeartbeatTimeout, 3000);
  put_word(0x93c, kTicksPerSecond >> 32U);
  put_word(0x940, static_cast<std::uint32_t>(kTicksPerSecond));
  put_word(address::kStreamPacketSize, 1500);
}

void CameraRegisters::fill_features(const CameraSetup& setup) {
  put_word(address::kSensorWidth, static_cast<std::uint32_t>(setup.sensor.width));
  put_word(address::kSensorHeight, static_cast<std::uint32_t>(setup.sensor.height));
  put_word(address::kWidth, static_cast<std::uint32_t>(setup.size.width));
  put_word(address::kHeight, static_cast<std::uint32_t>(setup.size.height));
  put_word(address::kPixelFormat, setup.format.number);
  put_word(address::kFrameRateEnable, 1);
  put_real(address::kFrameRate, setup.fps_hz);
  put_real(address::kExposureTime, static_cast<double>(setup.exposure.count()));
  put_word(address::kExposureAuto, setup.is_exposure_automatic ? kAutoContinuous : kAutoOff);
  put_word(address::kTriggerSource, kTriggerSourceLine0);
  update_payload_size();
}

Bytes CameraRegisters::read(std::uint32_t from, std::size_t size) const {
  const std::lock_guard lock(mutex_);
  if (from > memory_.size() || size > memory_.size() - from) return {};
  const std::span bytes = std::span(memory_).subspan(from, size);
  return {bytes.begin(), bytes.end()};
}

GvcpStatus CameraRegisters::write(std::uint32_t to, std::span<const std::uint8_t> value) {
  const std::lock_guard lock(mutex_);
  if (value.size() < 4 || to > memory_.size() || value.size() > memory_.size() - to) return GvcpStatus::InvalidAddress;
  if (is_read_only(to)) return GvcpStatus::WriteProtected;
  if (const GvcpStatus status = check(to, value); status != GvcpStatus::Success) return status;
  std::copy(value.begin(), value.end(), memory_.begin() + to);
  if (to == address::kStreamPacketSize) put_word(to, word_at(to) & ~kFireTestPacket);
  update_payload_size();
  return GvcpStatus::Success;
}

GvcpStatus CameraRegisters::check(std::uint32_t to, std::span<const std::uint8_t> value) const {
  const auto now = [this](std::uint32_t at) { return word_at(at); };
  const auto number = read_big_endian<std::uint32_t>(value);
  if (is_real(to)) {
    if (value.size() != 8) return GvcpStatus::InvalidParameter;
    const double real = std::bit_cast<double>(read_big_endian<std::uint64_t>(value));
    if (to == address::kFrameRate) return require(real >= kLeastFps && real <= kMostFps);
    if (to == address::kGain && now(address::kGainAuto) != kAutoOff) return GvcpStatus::WriteProtected;
    if (to == address::kGain) return require(real >= 0 && real <= kMostGainDb);
    if (now(address::kExposureAuto) != kAutoOff) return GvcpStatus::WriteProtected;
    return require(real >= kLeastExposureUs && real <= kMostExposureUs);
  }
  const std::uint32_t sensor_width = now(address::kSensorWidth);
  const std::uint32_t sensor_height = now(address::kSensorHeight);
  switch (to) {
    case address::kWidth:
      return require(number >= 1 && number + now(address::kOffsetX) <= sensor_width);
    case address::kHeight:
      return require(number >= 1 && number + now(address::kOffsetY) <= sensor_height);
    case address::kOffsetX:
      return require(number + now(address::kWidth) <= sensor_width);
    case address::kOffsetY:
      return require(number + now(address::kHeight) <= sensor_height);
    case address::kPixelFormat:
      return require(find_payload_format(number).has_value());
    case address::kStreamPacketSize:
      return require((number & kPacketSizeMask) >= kLeastPacketSize && (number & kPacketSizeMask) <= kMostPacketSize);
    default:
      return GvcpStatus::Success;
  }
}

void CameraRegisters::update_payload_size() {
  const cv::Size size(static_cast<int>(word_at(address::kWidth)), static_cast<int>(word_at(address::kHeight)));
  const PayloadFormat format = *find_payload_format(word_at(address::kPixelFormat));
  put_word(address::kPayloadSize, static_cast<std::uint32_t>(payload_size(format, size)));
}

std::uint32_t CameraRegisters::word(std::uint32_t from) const {
  const std::lock_guard lock(mutex_);
  return word_at(from);
}

void CameraRegisters::set_word(std::uint32_t to, std::uint32_t value) {
  const std::lock_guard lock(mutex_);
  put_word(to, value);
}

void CameraRegisters::set_timestamp(std::uint64_t ticks) {
  const std::lock_guard lock(mutex_);
  write_big_endian(std::span(memory_).subspan(address::kTimestampLatched), ticks);
}

AcquisitionSettings CameraRegisters::acquisition() const {
  const std::lock_guard lock(mutex_);
  const auto number = [this](std::uint32_t at) { return static_cast<int>(word_at(at)); };
  const bool has_rate = word_at(address::kFrameRateEnable) != 0;
  return {.region = {number(address::kOffsetX), number(address::kOffsetY), number(address::kWidth),
                     number(address::kHeight)},
          .format = *find_payload_format(word_at(address::kPixelFormat)),
          .period = has_rate ? from_us(1e6 / real_at(address::kFrameRate)) : std::chrono::nanoseconds(0),
          .exposure = from_us(real_at(address::kExposureTime)),
          .is_triggered = word_at(address::kTriggerMode) != 0,
          .is_single = word_at(address::kAcquisitionMode) == kSingleFrame};
}

StreamTarget CameraRegisters::stream_target() const {
  const std::lock_guard lock(mutex_);
  return {.address = word_at(address::kStreamDestination),
          .port = static_cast<std::uint16_t>(word_at(address::kStreamPort)),
          .packet_size = word_at(address::kStreamPacketSize) & kPacketSizeMask};
}

bool CameraRegisters::is_trigger_software() const {
  const std::lock_guard lock(mutex_);
  return word_at(address::kTriggerMode) != 0 && word_at(address::kTriggerSource) == kTriggerSourceSoftware;
}

std::uint32_t CameraRegisters::word_at(std::uint32_t from) const {
  return read_big_endian<std::uint32_t>(std::span(memory_).subspan(from));
}

double CameraRegisters::real_at(std::uint32_t from) const {
  return std::bit_cast<double>(read_big_endian<std::uint64_t>(std::span(memory_).subspan(from)));
}

void CameraRegisters::put_word(std::uint32_t to, std::uint32_t value) {
  write_big_endian(std::span(memory_).subspan(to), value);
}

void CameraRegisters::put_real(std::uint32_t to, double value) {
  write_big_endian(std::span(memory_).subspan(to), std::bit_cast<std::uint64_t>(value));
}

void CameraRegisters::put_text(std::uint32_t to, const std::string& text, std::size_t size) {
  std::copy_n(text.begin(), std::min(text.size(), size - 1), memory_.begin() + to);
}

}  // namespace alidade::test
