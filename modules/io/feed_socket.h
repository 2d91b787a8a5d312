// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "io/feed_address.h"

namespace alidade {

/// An open file descriptor that is closed with its owner.
class OpenFile {
 public:
  OpenFile() = default;
  explicit OpenFile(int number) : number_(number) {}
  ~OpenFile();
  OpenFile(OpenFile&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  OpenFile& operator=(OpenFile&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  int number() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }

 private:
  int number_ = -1;
};

/// A TCP socket that listens at the address, without blocking. Throws DeviceError: a name that does not resolve, an
/// address that is not this machine's, a port in use.
OpenFile listen_at(const FeedAddress& address);

/// The port at which a socket listens.
int port_of(const OpenFile& listener);

/// The next reader that waits at a listening socket: without blocking, its packets leave at once, and the system keeps
/// little of what it has not read. Empty where none waits.
OpenFile accept_reader(const OpenFile& listener);

/// A UDP socket whose datagrams go to the address, without blocking. Throws DeviceError for a name that does not
/// resolve or an address that cannot be reached.
OpenFile open_udp(const FeedAddress& address);

}  // namespace alidade
