// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "tests/support/gige_camera/big_endian.h"

namespace alidade::test {

/// The UDP port of every GigE Vision camera.
constexpr std::uint16_t kGvcpPort = 3956;

/// What a control program asks of a camera. An answer bears the command's number plus one.
/// Source: GigE Vision 1.2, GVCP; names and numbers as in Aravis' arvgvcpprivate.h.
enum class GvcpCommand : std::uint16_t {
  Discovery = 0x0002,
  PacketResend = 0x0040,
  ReadRegister = 0x0080,
  WriteRegister = 0x0082,
  ReadMemory = 0x0084,
  WriteMemory = 0x0086,
};

enum class GvcpStatus : std::uint16_t {
  Success = 0x0000,
  NotImplemented = 0x8001,
  InvalidParameter = 0x8002,
  InvalidAddress = 0x8003,
  WriteProtected = 0x8004,
  AccessDenied = 0x8006,
};

/// A datagram of the control program. `data` lies in the datagram.
struct GvcpRequest {
  GvcpCommand command{};
  bool wants_answer = true;
  bool has_extended_ids = false;
  std::uint16_t id = 0;
  std::span<const std::uint8_t> data;
};

/// Empty where the datagram is no command or cut off.
std::optional<GvcpRequest> parse_gvcp(std::span<const std::uint8_t> datagram);

/// The datagram that answers `request`.
Bytes gvcp_answer(const GvcpRequest& request, GvcpStatus status, std::span<const std::uint8_t> data);

/// Which packets of a frame a control program asks for once more, first and last included.
struct ResendRequest {
  std::uint16_t frame_id = 0;
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

/// Of a PacketResend request with 16-bit frame ids; empty where it is cut off.
std::optional<ResendRequest> parse_resend(const GvcpRequest& request);

}  // namespace alidade::test
