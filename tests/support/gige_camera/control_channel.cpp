// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/control_channel.h"

namespace alidade::test {
namespace {

constexpr std::size_t kDiscoverySize = 0xf8;
constexpr std::uint32_t kFireTestPacket = 1U << 31U;
constexpr std::uint32_t kLatch = 2;

ControlReply refusal(const GvcpRequest& request, GvcpStatus status) {
  return {.answer = gvcp_answer(request, status, {}), .effect = ControlEffect::None, .resend = std::nullopt};
}

ControlReply success(const GvcpRequest& request, std::span<const std::uint8_t> data) {
  return {.answer = gvcp_answer(request, GvcpStatus::Success, data), .effect = {}, .resend = std::nullopt};
}

ControlEffect effect_of(std::uint32_t to, std::uint32_t value, bool is_trigger_software) {
  switch (to) {
    case address::kAcquisitionStart:
      return ControlEffect::Start;
    case address::kAcquisitionStop:
      return ControlEffect::Stop;
    case address::kTriggerSoftware:
      return is_trigger_software ? ControlEffect::SoftwareTrigger : ControlEffect::None;
    case address::kStreamPacketSize:
      return (value & kFireTestPacket) != 0 ? ControlEffect::FireTestPacket : ControlEffect::None;
    case address::kTimestampControl:
      return (value & kLatch) != 0 ? ControlEffect::LatchTimestamp : ControlEffect::None;
    default:
      return ControlEffect::None;
  }
}

}  // namespace

ControlReply ControlChannel::reply(std::span<const std::uint8_t> datagram, const Peer& sender, HostTime now) {
  const std::optional<GvcpRequest> request = parse_gvcp(datagram);
  if (!request) return {};
  if (is_controller(sender)) last_heard_ = now;
  ControlReply reply;
  switch (request->command) {
    case GvcpCommand::Discovery:
      reply = success(*request, registers_.read(0, kDiscoverySize));
      break;
    case GvcpCommand::PacketResend:  // comes from the port of the stream
      if (controller_ && controller_->address == sender.address) reply.resend = parse_resend(*request);
      return reply;
    case GvcpCommand::ReadRegister:
      reply = read_registers(*request);
      break;
    case GvcpCommand::ReadMemory:
      reply = read_memory(*request);
      break;
    case GvcpCommand::WriteRegister:
      reply = write_registers(*request, sender);
      break;
    case GvcpCommand::WriteMemory:
      reply = write_memory(*request, sender);
      break;
    default:
      reply = refusal(*request, GvcpStatus::NotImplemented);
  }
  if (is_controller(sender)) last_heard_ = now;
  if (!request->wants_answer) reply.answer.clear();
  return reply;
}

bool ControlChannel::expire(HostTime now) {
  const std::chrono::milliseconds patience(registers_.word(address::kHeartbeatTimeout));
  if (!controller_ || now - last_heard_ <= patience) return false;
  release();
  return true;
}

void ControlChannel::release() {
  controller_.reset();
  registers_.set_word(address::kControlPrivilege, 0);
  registers_.set_word(address::kStreamPort, 0);
}

GvcpStatus ControlChannel::write_privilege(std::uint32_t privilege, const Peer& sender, ControlReply& reply) {
  if (controller_ && !is_controller(sender)) return GvcpStatus::AccessDenied;
  if (privilege == 0) {
    release();
    reply.effect = ControlEffect::Stop;
    return GvcpStatus::Success;
  }
  controller_ = sender;
  registers_.set_word(address::kControlPrivilege, privilege);
  return GvcpStatus::Success;
}

GvcpStatus ControlChannel::write(std::uint32_t to, std::span<const std::uint8_t> value, const Peer& sender,
                                 ControlReply& reply) {
  const auto number = read_big_endian<std::uint32_t>(value);
  if (to == address::kControlPrivilege) return write_privilege(number, sender, reply);
  if (!is_controller(sender)) return GvcpStatus::AccessDenied;
  const GvcpStatus status = registers_.write(to, value);
  if (status == GvcpStatus::Success) reply.effect = effect_of(to, number, registers_.is_trigger_software());
  return status;
}

ControlReply ControlChannel::write_registers(const GvcpRequest& request, const Peer& sender) {
  ControlReply reply;
  constexpr std::size_t kPair = 8;  // an address and a value
  if (request.data.empty() || request.data.size() % kPair != 0) return refusal(request, GvcpStatus::InvalidParameter);
  std::uint32_t written = 0;
  GvcpStatus status = GvcpStatus::Success;
  for (std::span rest = request.data; !rest.empty() && status == GvcpStatus::Success; rest = rest.subspan(kPair)) {
    status = write(read_big_endian<std::uint32_t>(rest), rest.subspan(4, 4), sender, reply);
    if (status == GvcpStatus::Success) ++written;
  }
  Bytes count;
  append_big_endian(count, written);
  reply.answer = gvcp_answer(request, status, count);
  return reply;
}

ControlReply ControlChannel::write_memory(const GvcpRequest& request, const Peer& sender) {
  if (request.data.size() < 8) return refusal(request, GvcpStatus::InvalidParameter);
  ControlReply reply;
  const auto to = read_big_endian<std::uint32_t>(request.data);
  const GvcpStatus status = write(to, request.data.subspan(4), sender, reply);
  reply.answer = gvcp_answer(request, status, request.data.first(4));
  return reply;
}

ControlReply ControlChannel::read_registers(const GvcpRequest& request) const {
  if (request.data.empty() || request.data.size() % 4 != 0) return refusal(request, GvcpStatus::InvalidParameter);
  Bytes values;
  for (std::span rest = request.data; !rest.empty(); rest = rest.subspan(4)) {
    const Bytes value = registers_.read(read_big_endian<std::uint32_t>(rest), 4);
    if (value.empty()) return refusal(request, GvcpStatus::InvalidAddress);
    values.insert(values.end(), value.begin(), value.end());
  }
  return success(request, values);
}

ControlReply ControlChannel::read_memory(const GvcpRequest& request) const {
  if (request.data.size() < 8) return refusal(request, GvcpStatus::InvalidParameter);
  const auto from = read_big_endian<std::uint32_t>(request.data);
  const Bytes memory = registers_.read(from, read_big_endian<std::uint16_t>(request.data.subspan(6)));
  if (memory.empty()) return refusal(request, GvcpStatus::InvalidAddress);
  Bytes data(request.data.begin(), request.data.begin() + 4);
  data.insert(data.end(), memory.begin(), memory.end());
  return success(request, data);
}

}  // namespace alidade::test
