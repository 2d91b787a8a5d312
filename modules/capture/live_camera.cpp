// SPDX-License-Identifier: Apache-2.0
#include "capture/live_camera.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "capture/clock_offset.h"

namespace alidade {
namespace {

using std::chrono::nanoseconds;

constexpr nanoseconds kLongestWait = std::chrono::milliseconds(50);  // how late a stop request may be seen

CaptureEventKind event_of(CameraTrouble trouble) {
  return trouble == CameraTrouble::Busy ? CaptureEventKind::InUse : CaptureEventKind::OpenFailed;
}

// V4L2 counts in 32 bits: a small count after a large one goes on behind the wrap. Some drivers give a count twice when
// they are late. Empty where the count started anew.
std::optional<std::uint64_t> steps_between(std::uint64_t last, std::uint64_t next) {
  if (next >= last) return next - last;
  const auto wrapped = static_cast<std::uint32_t>(next - last);
  const bool near_wrap = last >> 32 == 0 && wrapped < 10'000;
  return near_wrap ? std::optional<std::uint64_t>(wrapped) : std::nullopt;
}

class LiveCamera : public FrameSource {
 public:
  LiveCamera(std::string name, CameraOpener open, const LiveCameraOptions& options, CaptureEventSink events)
      : name_(std::move(name)), open_(std::move(open)), options_(options), events_(std::move(events)) {
    adopt(open_());
    const CameraFacts& facts = device_->facts();
    description_ = fmt::format("{} ({}, {}x{} px, {})", name_, facts.model, facts.size.width, facts.size.height,
                               facts.device_format);
  }

  ~LiveCamera() override { tell(CaptureEventKind::Closed, fmt::format("{} frames", next_index_)); }

  std::optional<Frame> next(std::stop_token stop) override {
    while (!stop.stop_requested()) {
      check_patience();
      if (!device_) {
        reopen(stop);
      } else if (auto frame = take()) {
        return finish(std::move(*frame));
      }
    }
    return std::nullopt;
  }

  std::optional<int> frame_count() const override { return std::nullopt; }
  bool has_times() const override { return true; }
  std::string describe() const override { return description_; }

 private:
  void tell(CaptureEventKind kind, std::string detail) const {
    if (events_) events_({kind, HostClock::now(), name_, next_index_, std::move(detail)});
  }

  void adopt(std::unique_ptr<CameraDevice> device) {
    device_ = std::move(device);
    const CameraFacts& facts = device_->facts();
    const std::string rate = facts.period ? fmt::format(" at {:.4g} Hz", 1e9 / facts.period->count()) : "";
    tell(CaptureEventKind::Opened,
         fmt::format("{}x{} px {}{}", facts.size.width, facts.size.height, facts.device_format, rate));
    last_sequence_.reset();
    clock_ = ClockOffset();
    interval_ = facts.period.value_or(nanoseconds(0));
    is_streaming_ = is_stalled_ = false;
    alive_ = HostClock::now();
    last_trouble_.reset();
  }

  // What counts as one frame's time: as granted, or as it really is where that is longer.
  nanoseconds period() const { return std::max(interval_, device_->facts().period.value_or(nanoseconds(0))); }

  nanoseconds silence_allowed() const {
    const auto by_periods = from_seconds(options_.stall_periods * to_seconds(period()));
    const auto least = std::max(by_periods, from_seconds(options_.least_stall_s));
    return is_streaming_ ? least : least + from_seconds(options_.first_frame_s);
  }

  std::optional<Frame> take() {
    const nanoseconds until_stall = alive_ + silence_allowed() - HostClock::now();
    const bool is_due = !options_.is_triggered && !is_stalled_;
    const nanoseconds patience = is_due ? std::clamp(until_stall, nanoseconds(1'000'000), kLongestWait) : kLongestWait;
    try {
      auto frame = device_->wait(patience);
      if (!frame) watch();
      return frame;
    } catch (const CameraError& error) {
      tell(CaptureEventKind::Disconnected, error.what());
      device_.reset();
      retry_at_ = HostClock::now();
    }
    return std::nullopt;
  }

  // No frame has come.
  void watch() {
    if (options_.is_triggered) return;
    const nanoseconds silence = HostClock::now() - alive_;
    if (!is_stalled_ && silence >= silence_allowed()) {
      is_stalled_ = true;
      tell(CaptureEventKind::Stalled, fmt::format("no frame for {:.0f} ms", 1e3 * to_seconds(silence)));
    }
    if (silence >= silence_allowed() + from_seconds(options_.reopen_after_s)) {
      device_.reset();
      retry_at_ = HostClock::now();
    }
  }

  void reopen(std::stop_token stop) {
    {
      std::unique_lock lock(sleep_mutex_);
      sleep_.wait_until(lock, stop, retry_at_, [] { return false; });
    }
    if (stop.stop_requested()) return;
    try {
      adopt(open_());
    } catch (const CameraError& error) {
      if (last_trouble_ != error.trouble()) tell(event_of(error.trouble()), error.what());
      last_trouble_ = error.trouble();
      last_refusal_ = error.what();
      retry_at_ = HostClock::now() + std::chrono::duration_cast<HostClock::duration>(from_seconds(options_.retry_s));
    }
  }

  void check_patience() const {
    if (!options_.give_up_s || options_.is_triggered) return;
    const double silence_s = to_seconds(HostClock::now() - last_frame_);
    if (silence_s < *options_.give_up_s) return;
    throw CameraError(CameraTrouble::Gone, name_, "gives no frames",
                      fmt::format("none for {:.1f} s{}", silence_s, last_refusal_.empty() ? "" : ", " + last_refusal_),
                      "check cable, power and --set options");
  }

  Frame finish(Frame frame) {
    const HostTime now = HostClock::now();
    if (!frame.stamp.host_time) frame.stamp.host_time = now;
    // What is left of a frame that was cut off by a dying camera is no sign of life.
    if (!frame.stamp.is_damaged || !is_stalled_) live_on(now);
    count_drops(frame.stamp);
    if (frame.stamp.is_damaged) tell(CaptureEventKind::FrameDamaged, "the device flags errors in it");
    frame.time = std::max(moment(frame), last_time_ + nanoseconds(1));
    last_time_ = frame.time;
    frame.index = next_index_++;
    frame.name = fmt::format("{}#{}", name_, frame.index);
    return frame;
  }

  void live_on(HostTime now) {
    if (!is_streaming_) tell(CaptureEventKind::Streaming, "");
    if (is_stalled_) tell(CaptureEventKind::Resumed, "");
    if (is_streaming_ && !is_stalled_) interval_ = (interval_ * 7 + (now - alive_)) / 8;
    is_streaming_ = true;
    is_stalled_ = false;
    alive_ = last_frame_ = now;
  }

  void count_drops(CaptureStamp& stamp) {
    if (!stamp.sequence) return;
    if (last_sequence_) {
      const auto steps = steps_between(*last_sequence_, *stamp.sequence);
      if (!steps) {
        tell(CaptureEventKind::Restarted, fmt::format("frame {} after {}", *stamp.sequence, *last_sequence_));
      } else if (*steps > 1) {
        stamp.dropped_before += *steps - 1;
        tell(CaptureEventKind::FramesDropped, fmt::format("{} before frame {}", *steps - 1, *stamp.sequence));
      }
    }
    last_sequence_ = stamp.sequence;
  }

  // The middle of the exposure on the host's clock, as well as it is known.
  Timestamp moment(const Frame& frame) {
    const CameraFacts& facts = device_->facts();
    const CaptureStamp& stamp = frame.stamp;
    Timestamp time(stamp.host_time->time_since_epoch());
    if (stamp.device_time && facts.is_host_clock) {
      time = *stamp.device_time;
    } else if (stamp.device_time) {
      // What was stamped as its exposure began is sent once that is over.
      const bool is_early = facts.stamped == StampedMoment::ExposureStart;
      const nanoseconds before_sent = is_early ? facts.exposure.value_or(nanoseconds(0)) : nanoseconds(0);
      if (clock_.observe(*stamp.device_time, *stamp.host_time - before_sent)) {
        tell(CaptureEventKind::Restarted, "its clock was set anew");
      }
      time = Timestamp(clock_.to_host(*stamp.device_time)->time_since_epoch());
    }
    return stamp.device_time ? time + stamp_to_middle(facts) : time;
  }

  const std::string name_;
  const CameraOpener open_;
  const LiveCameraOptions options_;
  const CaptureEventSink events_;
  std::string description_;
  std::unique_ptr<CameraDevice> device_;  // empty while lost
  ClockOffset clock_;
  std::optional<std::uint64_t> last_sequence_;
  std::optional<CameraTrouble> last_trouble_;  // of attempts to open since the last success
  std::string last_refusal_;
  HostTime retry_at_{};
  HostTime alive_{};                        // opened, or gave its last frame
  HostTime last_frame_ = HostClock::now();  // or the beginning
  Timestamp last_time_{};
  nanoseconds interval_{};  // between frames, smoothed
  bool is_streaming_ = false, is_stalled_ = false;
  int next_index_ = 0;
  std::mutex sleep_mutex_;
  std::condition_variable_any sleep_;
};

}  // namespace

void validate(const LiveCameraOptions& options) {
  const auto check = [](const char* field, double value, double bound) {
    if (!(value >= bound) || !std::isfinite(value)) {
      throw std::invalid_argument(fmt::format("{} must be >= {}, got {}", field, bound, value));
    }
  };
  check("stall_periods", options.stall_periods, 1.5);
  check("least_stall_s", options.least_stall_s, 0);
  check("first_frame_s", options.first_frame_s, 0);
  check("reopen_after_s", options.reopen_after_s, 0);
  check("retry_s", options.retry_s, 0.01);
  if (options.give_up_s) check("give_up_s", *options.give_up_s, 0.1);
}

std::unique_ptr<FrameSource> open_live_camera(std::string name, CameraOpener open, const LiveCameraOptions& options,
                                              CaptureEventSink events) {
  validate(options);
  if (!open) throw std::invalid_argument("open_live_camera: an opener is needed");
  return std::make_unique<LiveCamera>(std::move(name), std::move(open), options, std::move(events));
}

}  // namespace alidade
