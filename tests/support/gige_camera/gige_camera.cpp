// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/gige_camera.h"

#include <algorithm>

namespace alidade::test {
namespace {

constexpr std::chrono::milliseconds kIdle(20);  // between two looks at the heartbeat
constexpr std::size_t kWaitingTriggers = 4;     // more are ignored, as a camera does that is still busy

std::uint16_t frame_id(std::uint16_t first, std::uint64_t frame) {
  return static_cast<std::uint16_t>(1 + (first - 1 + frame) % 0xffff);  // 0 is no id
}

}  // namespace

GigeCamera::GigeCamera(const GigeCameraOptions& options, std::unique_ptr<PictureSource> pictures)
    : options_(options),
      pictures_(std::move(pictures)),
      registers_(options.setup),
      control_(registers_),
      sender_(options.setup.address, options.sender),
      commands_(options.setup.address, kGvcpPort),
      random_(options.sender.seed) {
  if (options_.log) log_.emplace(*options_.log);
  registers_.set_word(address::kStreamSourcePort, sender_.source_port());
  commander_ = std::jthread([this](const std::stop_token& stop) { serve_commands(stop); });
  exposer_ = std::jthread([this](const std::stop_token& stop) { expose_always(stop); });
}

GigeCamera::~GigeCamera() = default;

void GigeCamera::pulse() {
  if (registers_.acquisition().is_triggered && !registers_.is_trigger_software()) trigger(HostClock::now());
}

void GigeCamera::stall(std::chrono::nanoseconds duration) {
  const std::lock_guard lock(mutex_);
  stalled_until_ = HostClock::now() + duration;
}

void GigeCamera::drop_frames(int count) {
  const std::lock_guard lock(mutex_);
  frames_to_drop_ += count;
}

void GigeCamera::ignore_commands(std::chrono::nanoseconds duration) {
  const std::lock_guard lock(mutex_);
  deaf_until_ = HostClock::now() + duration;
}

void GigeCamera::serve_commands(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    auto patience = kIdle;
    if (!resends_.empty()) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(resends_.front().due - HostClock::now());
      patience = std::clamp(left, std::chrono::milliseconds(0), kIdle);
    }
    const auto datagram = commands_.receive(patience);
    const HostTime now = HostClock::now();
    const bool is_deaf = [&] {
      const std::lock_guard lock(mutex_);
      return now < deaf_until_;
    }();
    if (datagram && !is_deaf) obey(control_.reply(datagram->first, datagram->second, now), datagram->second, now);
    if (control_.expire(now)) stop_acquisition();
    send_due_resends(now);
  }
}

void GigeCamera::obey(const ControlReply& reply, const Peer& sender, HostTime now) {
  switch (reply.effect) {
    case ControlEffect::None:
      break;
    case ControlEffect::Start:
      start_acquisition();
      break;
    case ControlEffect::Stop:
      stop_acquisition();
      break;
    case ControlEffect::SoftwareTrigger:
      trigger(now);
      break;
    case ControlEffect::FireTestPacket:
      sender_.send_test_packet(registers_.stream_target().packet_size, stream_peer());
      break;
    case ControlEffect::LatchTimestamp:
      registers_.set_timestamp(options_.clock.ticks(HostClock::now()));
      break;
  }
  if (!reply.answer.empty()) commands_.send(reply.answer, sender);
  if (reply.resend) resends_.push_back({now + options_.resend_delay, *reply.resend});
}

void GigeCamera::send_due_resends(HostTime now) {
  for (; !resends_.empty() && resends_.front().due <= now; resends_.pop_front()) {
    sender_.resend(resends_.front().request, stream_peer());
  }
}

Peer GigeCamera::stream_peer() const {
  const StreamTarget target = registers_.stream_target();
  return {target.address, target.port};
}

void GigeCamera::start_acquisition() {
  const std::lock_guard lock(mutex_);
  is_acquiring_ = true;
  ++acquisition_;
  triggers_.clear();
  sender_.forget();
  changed_.notify_all();
}

void GigeCamera::stop_acquisition() {
  const std::lock_guard lock(mutex_);
  is_acquiring_ = false;
  changed_.notify_all();
}

void GigeCamera::trigger(HostTime now) {
  const std::lock_guard lock(mutex_);
  if (is_acquiring_ && triggers_.size() < kWaitingTriggers) triggers_.push_back(now);
  changed_.notify_all();
}

void GigeCamera::expose_always(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return is_acquiring_; })) return;
    }
    run_acquisition(stop);
  }
}

void GigeCamera::run_acquisition(const std::stop_token& stop) {
  const AcquisitionSettings first = registers_.acquisition();
  const int acquisition = [this] {
    const std::lock_guard lock(mutex_);
    return acquisition_;
  }();
  std::optional<HostTime> last;
  for (std::uint64_t frame = 0;; ++frame) {
    AcquisitionSettings settings = registers_.acquisition();
    settings.region = first.region;  // these two only change between acquisitions
    settings.format = first.format;
    const std::optional<HostTime> start = next_exposure(stop, last, settings);
    {
      const std::lock_guard lock(mutex_);
      if (!start || acquisition != acquisition_) return;
    }
    last = start;
    if (!expose({stop, acquisition, frame, *start}, settings) || settings.is_single) return stop_acquisition();
  }
}

bool GigeCamera::wait_until(std::unique_lock<std::mutex>& lock, const std::stop_token& stop, HostTime time) {
  changed_.wait_until(lock, stop, time, [this] { return !is_acquiring_; });
  return is_acquiring_ && !stop.stop_requested();
}

std::optional<HostTime> GigeCamera::next_exposure(const std::stop_token& stop, std::optional<HostTime> last,
                                                  const AcquisitionSettings& settings) {
  std::unique_lock lock(mutex_);
  if (!is_acquiring_) return std::nullopt;
  if (settings.is_triggered) {
    changed_.wait(lock, stop, [this] { return !is_acquiring_ || !triggers_.empty(); });
    if (!is_acquiring_ || triggers_.empty()) return std::nullopt;
    const HostTime start = triggers_.front();
    triggers_.pop_front();
    return start;
  }
  const HostTime now = HostClock::now();
  HostTime start = last ? *last + std::max(settings.period, settings.exposure) : now;
  if (start + settings.exposure < now) start = now - settings.exposure;  // it exposed while we were sending
  if (start < stalled_until_) start = stalled_until_;
  return wait_until(lock, stop, start) ? std::optional(start) : std::nullopt;
}

bool GigeCamera::is_frame_dropped() {
  const std::lock_guard lock(mutex_);
  if (frames_to_drop_ > 0) return frames_to_drop_-- > 0;
  return options_.drop_share > 0 && std::bernoulli_distribution(options_.drop_share)(random_);
}

bool GigeCamera::expose(const Exposure& exposure, const AcquisitionSettings& settings) {
  const auto& [stop, acquisition, frame, start] = exposure;
  const std::optional<std::uint32_t> picture = pictures_->picture_at(frame);
  if (!picture) return false;
  const LoggedFrame logged{.acquisition = acquisition,
                           .frame = frame,
                           .id = frame_id(options_.first_frame_id, frame),
                           .picture = *picture,
                           .device_time = options_.clock.ticks(start),
                           .host_time = start,
                           .exposure = settings.exposure,
                           .is_dropped = is_frame_dropped()};
  const std::shared_ptr<OutgoingFrame> out = sender_.spare_frame();
  out->id = logged.id;
  out->data_per_packet = registers_.stream_target().packet_size - kGvspOverhead;
  out->leader = gvsp_leader({settings.format.number, settings.region, logged.device_time});
  out->trailer = gvsp_trailer(settings.region.height);
  out->payload.resize(payload_size(settings.format, settings.region.size()));
  write_payload(pictures_->picture(*picture, settings.region, settings.format.pixel), settings.format, out->payload);
  {
    std::unique_lock lock(mutex_);
    if (!wait_until(lock, stop, start + settings.exposure)) return true;
  }
  if (log_) log_->add(logged);
  const Peer to = stream_peer();
  if (!logged.is_dropped && to.port != 0) sender_.send(out, to);
  return true;
}

}  // namespace alidade::test
