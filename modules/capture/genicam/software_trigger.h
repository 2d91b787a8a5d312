// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "capture/frame_source.h"

namespace alidade {

/// The first multiple of `period` on the host's clock after `now`.
HostTime next_multiple(HostTime now, std::chrono::nanoseconds period);

/// Calls `fire` at the multiples of a period on the host's clock, in a thread of its own: a camera that does not answer
/// holds up nobody else. A multiple that passes while `fire` runs is left out.
class SoftwareTrigger {
 public:
  SoftwareTrigger(std::chrono::nanoseconds period, std::function<void()> fire);

 private:
  void run(std::stop_token stop);

  const std::chrono::nanoseconds period_;
  const std::function<void()> fire_;
  std::mutex mutex_;
  std::condition_variable_any stopped_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace alidade
