// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/gvcp.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace alidade {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint16_t kPort = 3956;
constexpr int kTries = 3;
constexpr std::size_t kHeader = 8;

// Commands, each followed by the number of its answer.
constexpr std::uint16_t kDiscover = 0x0002, kWriteRegister = 0x0082;
constexpr std::uint16_t kControlPrivilege = 0x0A00;  // register: 2 takes control, 0 gives it back
constexpr std::uint16_t kDenied = 0x8006;

void append16(std::vector<std::uint8_t>& bytes, std::uint16_t value) {
  bytes.push_back(static_cast<std::uint8_t>(value >> 8));
  bytes.push_back(static_cast<std::uint8_t>(value));
}

std::uint16_t read16(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

std::string text(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t length) {
  const auto field = bytes.subspan(at, length);
  return {field.begin(), std::find(field.begin(), field.end(), 0)};
}

// A socket to the control port of one camera: connected, so that a host without a camera is heard to refuse.
class ControlSocket {
 public:
  explicit ControlSocket(const std::string& address) : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in camera{};
    camera.sin_family = AF_INET;
    camera.sin_port = htons(kPort);
    if (fd_ < 0 || inet_pton(AF_INET, address.c_str(), &camera.sin_addr) != 1) return;
    is_connected_ = connect(fd_, reinterpret_cast<const sockaddr*>(&camera), sizeof camera) == 0;
  }
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;
  ~ControlSocket() {
    if (fd_ >= 0) close(fd_);
  }

  std::string host_address() const {
    sockaddr_in own{};
    socklen_t size = sizeof own;
    std::array<char, INET_ADDRSTRLEN> name{};
    if (getsockname(fd_, reinterpret_cast<sockaddr*>(&own), &size) != 0) return "";
    return inet_ntop(AF_INET, &own.sin_addr, name.data(), name.size()) ? name.data() : "";
  }

  // The answer with its header; empty where none came.
  std::vector<std::uint8_t> ask(std::uint16_t command, std::span<const std::uint8_t> content,
                                std::chrono::milliseconds patience) {
    if (!is_connected_) return {};
    ++id_;
    std::vector<std::uint8_t> packet{0x42, 0x01};  // a command; an answer is wanted
    for (const auto field : {command, static_cast<std::uint16_t>(content.size()), id_}) append16(packet, field);
    packet.insert(packet.end(), content.begin(), content.end());
    for (int i = 0; i < kTries; ++i) {
      if (send(fd_, packet.data(), packet.size(), MSG_NOSIGNAL) < 0) return {};
      const auto answer = receive(command + 1, Clock::now() + patience / kTries);
      if (!answer.empty()) return answer;
    }
    return {};
  }

 private:
  std::vector<std::uint8_t> receive(int expected, Clock::time_point until) {
    for (;;) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
      pollfd event{fd_, POLLIN, 0};
      if (left <= 0 || poll(&event, 1, static_cast<int>(left)) <= 0) return {};
      std::vector<std::uint8_t> bytes(1024);
      const ssize_t count = recv(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (count < 0) return {};  // refused: nobody listens there
      bytes.resize(static_cast<std::size_t>(count));
      if (bytes.size() >= kHeader && read16(bytes, 2) == expected && read16(bytes, 6) == id_) return bytes;
    }
  }

  int fd_;
  bool is_connected_ = false;
  std::uint16_t id_ = 0;
};

bool write_register(ControlSocket& camera, std::uint16_t address, std::uint8_t value,
                    std::chrono::milliseconds patience) {
  std::vector<std::uint8_t> content{0, 0};
  append16(content, address);
  content.insert(content.end(), {0, 0, 0, value});
  const auto answer = camera.ask(kWriteRegister, content, patience);
  return !answer.empty() && read16(answer, 0) != kDenied;
}

}  // namespace

std::optional<GigeIdentity> ask_gige_camera(const std::string& address, std::chrono::milliseconds patience) {
  constexpr std::size_t kLength = 0xF8;
  ControlSocket camera(address);
  const auto answer = camera.ask(kDiscover, {}, patience);
  if (answer.size() < kHeader + kLength) return std::nullopt;
  const auto identity = std::span(answer).subspan(kHeader);  // the first registers of the camera
  return GigeIdentity{camera.host_address(), text(identity, 0x48, 32), text(identity, 0x68, 32),
                      text(identity, 0xD8, 16), text(identity, 0xE8, 16)};
}

bool may_control_gige_camera(const std::string& address, std::chrono::milliseconds patience) {
  ControlSocket camera(address);
  if (!write_register(camera, kControlPrivilege, 2, patience)) return false;
  write_register(camera, kControlPrivilege, 0, patience);
  return true;
}

}  // namespace alidade
