// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace alidade {

/// Where lines of text go while they are made.
struct FeedAddress {
  enum class Kind {
    StandardOutput,
    Tcp,  ///< we listen there, readers come and go
    Udp,  ///< we send there, one line per datagram
  };

  Kind kind = Kind::StandardOutput;
  std::string host;  ///< name or number; empty: this machine alone (127.0.0.1); "*": every address of this machine
  int port = 0;      ///< of Tcp, 0 lets the system choose one

  friend bool operator==(const FeedAddress&, const FeedAddress&) = default;
};

/// "-", "tcp://HOST:PORT" or "udp://HOST:PORT"; an IPv6 number stands in brackets ("tcp://[::1]:5555"). Throws
/// InputError for anything else.
FeedAddress parse_feed_address(const std::string& text);

/// The same as text; an empty host as 127.0.0.1.
std::string to_string(const FeedAddress& address);

}  // namespace alidade
