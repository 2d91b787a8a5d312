// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "capture/frame_source.h"
#include "tests/support/gige_camera/camera_registers.h"
#include "tests/support/gige_camera/gvcp_message.h"

namespace alidade::test {

/// Where a datagram came from.
struct Peer {
  std::uint32_t address = 0;  ///< IPv4, as a number
  std::uint16_t port = 0;

  friend bool operator==(const Peer&, const Peer&) = default;
};

/// What the camera has to do upon a datagram, beside what the registers now say.
enum class ControlEffect { None, Start, Stop, SoftwareTrigger, FireTestPacket, LatchTimestamp };

struct ControlReply {
  Bytes answer;  ///< empty where none is wanted
  ControlEffect effect = ControlEffect::None;
  std::optional<ResendRequest> resend;
};

/// Whom the camera obeys, and what it answers: one program at a time has control, until it gives it back or falls
/// silent for the heartbeat's time; all others may only read.
class ControlChannel {
 public:
  explicit ControlChannel(CameraRegisters& registers) : registers_(registers) {}

  ControlReply reply(std::span<const std::uint8_t> datagram, const Peer& sender, HostTime now);

  /// Takes control from a program that has been silent for too long; true where that was the case.
  bool expire(HostTime now);

 private:
  bool is_controller(const Peer& sender) const { return controller_ == sender; }
  GvcpStatus write(std::uint32_t to, std::span<const std::uint8_t> value, const Peer& sender, ControlReply& reply);
  GvcpStatus write_privilege(std::uint32_t privilege, const Peer& sender, ControlReply& reply);
  void release();
  ControlReply write_registers(const GvcpRequest& request, const Peer& sender);
  ControlReply write_memory(const GvcpRequest& request, const Peer& sender);
  ControlReply read_registers(const GvcpRequest& request) const;
  ControlReply read_memory(const GvcpRequest& request) const;

  CameraRegisters& registers_;
  std::optional<Peer> controller_;
  HostTime last_heard_{};
};

}  // namespace alidade::test
