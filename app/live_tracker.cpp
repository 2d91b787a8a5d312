// SPDX-License-Identifier: Apache-2.0
#include "app/live_tracker.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <sys/resource.h>
#include <unistd.h>

namespace alidade {
namespace {

// Of a thread's niceness: frames come first.
void step_back() {
  constexpr int kSteps = 5;
  const auto thread = static_cast<id_t>(::gettid());
  ::setpriority(PRIO_PROCESS, thread, ::getpriority(PRIO_PROCESS, thread) + kSteps);
}

}  // namespace

LiveTracker::LiveTracker(CameraTracker& tracker, LiveTrackerOptions options)
    : tracker_(tracker),
      options_(options),
      follower_(tracker.camera(), tracker.options()),
      thread_([this](std::stop_token stop) { work(stop); }) {}

LiveTracker::~LiveTracker() {
  finish();
}

FrameReport LiveTracker::step(const ImageFrame& frame) {
  std::string reason;
  {
    const std::scoped_lock lock(mutex_);
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
    newest_ = frame;
    before_ = follower_.last();
    if (anchor_) follower_.put(*std::exchange(anchor_, std::nullopt));
    reason = reason_;
  }
  changed_.notify_all();
  FrameReport report = follower_.step(frame, reason);
  const std::scoped_lock lock(mutex_);
  is_followed_ = report.state == FrameState::Tracked;
  return report;
}

void LiveTracker::finish() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
}

void LiveTracker::work(std::stop_token stop) try {
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  step_back();
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return newest_.has_value(); })) {
    const ImageFrame frame = *std::exchange(newest_, std::nullopt);
    std::optional<TrackAnchor> before = std::exchange(before_, std::nullopt);
    lock.unlock();
    const auto begin = Clock::now();
    if (before) tracker_.resume_from(std::move(*before));
    const FrameReport report = tracker_.step(frame);
    std::optional<TrackAnchor> anchor = tracker_.anchor();
    const double busy_s = Seconds(Clock::now() - begin).count();
    lock.lock();
    if (anchor) anchor_ = std::move(anchor);
    reason_ = report.reason;
    const double rest_s = is_followed_ ? busy_s * (1.0 / options_.map_share - 1.0) : 0.0;  // the lost wait for it
    const double pause_s = std::max(options_.least_pause_s, rest_s);
    changed_.wait_for(lock, stop, Seconds(pause_s), [] { return false; });
  }
} catch (...) {
  const std::scoped_lock lock(mutex_);
  error_ = std::current_exception();
}

}  // namespace alidade
