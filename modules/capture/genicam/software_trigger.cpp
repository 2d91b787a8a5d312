// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/software_trigger.h"

#include <stdexcept>
#include <utility>

#include "capture/genicam/thread_urgency.h"

namespace alidade {

HostTime next_multiple(HostTime now, std::chrono::nanoseconds period) {
  return HostTime(HostTime::duration((now.time_since_epoch() / period + 1) * period));
}

SoftwareTrigger::SoftwareTrigger(std::chrono::nanoseconds period, std::function<void()> fire)
    : period_(period), fire_(std::move(fire)) {
  if (period <= std::chrono::nanoseconds::zero()) throw std::invalid_argument("SoftwareTrigger: period must be > 0");
  thread_ = std::jthread([this](std::stop_token stop) { run(stop); });
}

void SoftwareTrigger::run(std::stop_token stop) {
  make_this_thread_urgent();
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    stopped_.wait_until(lock, stop, next_multiple(HostClock::now(), period_), [] { return false; });
    if (!stop.stop_requested()) fire_();
  }
}

}  // namespace alidade
