// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <netinet/in.h>

#include "tests/support/gige_camera/big_endian.h"
#include "tests/support/gige_camera/control_channel.h"

namespace alidade::test {

/// The address as the kernel wants it.
sockaddr_in socket_address(const Peer& peer);

/// A UDP socket with an address of its own.
class UdpSocket {
 public:
  /// Port 0: any. Throws DeviceError where the address is not this machine's, or is in use.
  UdpSocket(const std::string& address, std::uint16_t port);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  int descriptor() const { return descriptor_; }
  Peer own() const;

  void send(std::span<const std::uint8_t> datagram, const Peer& to) const;

  /// The next datagram and its sender; empty where none came within `timeout`.
  std::optional<std::pair<Bytes, Peer>> receive(std::chrono::milliseconds timeout) const;

 private:
  int descriptor_ = -1;
};

}  // namespace alidade::test
