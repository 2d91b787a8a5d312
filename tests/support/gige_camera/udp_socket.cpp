// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/udp_socket.h"

#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/errors.h"

namespace alidade::test {
namespace {

constexpr std::size_t kLongestDatagram = 65536;

}  // namespace

sockaddr_in socket_address(const Peer& peer) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_addr.s_addr = htonl(peer.address);
  result.sin_port = htons(peer.port);
  return result;
}

UdpSocket::UdpSocket(const std::string& address, std::uint16_t port) {
  const std::string name = fmt::format("{}:{}", address, port);
  in_addr parsed{};
  if (inet_pton(AF_INET, address.c_str(), &parsed) != 1) {
    throw DeviceError(name, "bind", "not an IPv4 address", "give one like 127.0.0.1");
  }
  descriptor_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_in own = socket_address({ntohl(parsed.s_addr), port});
  if (descriptor_ < 0 || ::bind(descriptor_, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) {
    const int error = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw DeviceError(name, "bind", std::strerror(error),
                      "end the camera that runs there, or give another --address, such as 127.0.0.2");
  }
}

UdpSocket::~UdpSocket() {
  ::close(descriptor_);
}

Peer UdpSocket::own() const {
  sockaddr_in own{};
  socklen_t size = sizeof own;
  ::getsockname(descriptor_, reinterpret_cast<sockaddr*>(&own), &size);
  return {ntohl(own.sin_addr.s_addr), ntohs(own.sin_port)};
}

void UdpSocket::send(std::span<const std::uint8_t> datagram, const Peer& to) const {
  const sockaddr_in address = socket_address(to);
  ::sendto(descriptor_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&address),
           sizeof address);
}

std::optional<std::pair<Bytes, Peer>> UdpSocket::receive(std::chrono::milliseconds timeout) const {
  pollfd wanted{.fd = descriptor_, .events = POLLIN, .revents = 0};
  if (::poll(&wanted, 1, static_cast<int>(timeout.count())) <= 0) return std::nullopt;
  Bytes datagram(kLongestDatagram);
  sockaddr_in from{};
  socklen_t from_size = sizeof from;
  const ssize_t size = ::recvfrom(descriptor_, datagram.data(), datagram.size(), MSG_DONTWAIT,
                                  reinterpret_cast<sockaddr*>(&from), &from_size);
  if (size < 0) return std::nullopt;
  datagram.resize(static_cast<std::size_t>(size));
  return std::pair(std::move(datagram), Peer{ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)});
}

}  // namespace alidade::test
