// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <thread>

namespace alidade {

/// Turns Ctrl-C and SIGTERM into a stop request, so that the work ends in order and keeps what it has. The second
/// signal ends the program at once with 130. Made once, before any other thread: it blocks both signals in the calling
/// thread and all that this starts; a child process must unblock them for itself (posix_spawnattr_setsigmask).
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::jthread listener_;
};

}  // namespace alidade
