// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/gvcp_message.h"

namespace alidade::test {
namespace {

constexpr std::size_t kHeaderSize = 8;
constexpr std::uint8_t kKey = 0x42;  // every command begins with it
constexpr std::uint8_t kAnswerFlag = 0x01;
constexpr std::uint8_t kExtendedIdFlag = 0x10;

}  // namespace

std::optional<GvcpRequest> parse_gvcp(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < kHeaderSize || datagram[0] != kKey) return std::nullopt;
  const std::size_t size = read_big_endian<std::uint16_t>(datagram.subspan(4));
  if (datagram.size() < kHeaderSize + size) return std::nullopt;
  return GvcpRequest{.command = static_cast<GvcpCommand>(read_big_endian<std::uint16_t>(datagram.subspan(2))),
                     .wants_answer = (datagram[1] & kAnswerFlag) != 0,
                     .has_extended_ids = (datagram[1] & kExtendedIdFlag) != 0,
                     .id = read_big_endian<std::uint16_t>(datagram.subspan(6)),
                     .data = datagram.subspan(kHeaderSize, size)};
}

Bytes gvcp_answer(const GvcpRequest& request, GvcpStatus status, std::span<const std::uint8_t> data) {
  Bytes answer;
  append_big_endian(answer, static_cast<std::uint16_t>(status));
  append_big_endian(answer, static_cast<std::uint16_t>(static_cast<std::uint16_t>(request.command) + 1));
  append_big_endian(answer, static_cast<std::uint16_t>(data.size()));
  append_big_endian(answer, request.id);
  answer.insert(answer.end(), data.begin(), data.end());
  return answer;
}

std::optional<ResendRequest> parse_resend(const GvcpRequest& request) {
  if (request.data.size() < 12 || request.has_extended_ids) return std::nullopt;
  constexpr std::uint32_t kPacketIdMask = 0x00ffffff;
  return ResendRequest{.frame_id = read_big_endian<std::uint16_t>(request.data.subspan(2)),
                       .first = read_big_endian<std::uint32_t>(request.data.subspan(4)) & kPacketIdMask,
                       .last = read_big_endian<std::uint32_t>(request.data.subspan(8)) & kPacketIdMask};
}

}  // namespace alidade::test
