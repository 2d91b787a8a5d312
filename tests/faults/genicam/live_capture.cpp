// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/genicam/live_capture.h"

#include <algorithm>

#include <opencv2/core.hpp>

#include "capture/genicam/genicam_camera.h"
#include "tests/support/gige_camera/test_pattern.h"

namespace alidade::test {
namespace {

// The pattern's number takes kNumberPixels; narrower images are not for this.
SeenFrame look_at(const Frame& frame) {
  SeenFrame seen{.arrival = HostClock::now(), .time = frame.time, .stamp = frame.stamp, .picture = {}};
  if (frame.image.empty()) return seen;
  seen.picture = number_in_pattern(frame.image, frame.format);
  if (!seen.picture) return seen;
  const cv::Mat truth = test_pattern(*seen.picture, frame.image.size(), frame.format);
  seen.is_exact = truth.type() == frame.image.type() && cv::norm(truth, frame.image, cv::NORM_L1) == 0;
  return seen;
}

}  // namespace

LiveCapture::LiveCapture(const std::string& address, const CameraRequest& request, const LiveCameraOptions& options) {
  const auto note = [this](const CaptureEvent& event) {
    const std::lock_guard lock(mutex_);
    events_.push_back(event);
    changed_.notify_all();
  };
  source_ = open_live_camera(
      "genicam:" + address, [address, request] { return open_genicam(address, request); }, options, note);
  reader_ = std::jthread([this](const std::stop_token& stop) { read(stop); });
}

LiveCapture::~LiveCapture() {
  stop();
}

void LiveCapture::stop() {
  if (!reader_.joinable()) return;
  reader_.request_stop();
  reader_.join();
  source_.reset();
}

void LiveCapture::read(const std::stop_token& stop) {
  while (const std::optional<Frame> frame = source_->next(stop)) {
    SeenFrame seen = look_at(*frame);
    const std::lock_guard lock(mutex_);
    frames_.push_back(std::move(seen));
    changed_.notify_all();
  }
}

std::optional<SeenFrame> LiveCapture::wait_for_frame(HostTime after, std::chrono::milliseconds patience) {
  std::optional<SeenFrame> found;
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] {
    const auto is_it = [&](const SeenFrame& frame) { return frame.arrival > after && !frame.stamp.is_damaged; };
    const auto first = std::find_if(frames_.begin(), frames_.end(), is_it);
    if (first != frames_.end()) found = *first;
    return found.has_value();
  });
  return found;
}

std::optional<CaptureEvent> LiveCapture::wait_for_event(std::initializer_list<CaptureEventKind> kinds, HostTime after,
                                                        std::chrono::milliseconds patience) {
  std::optional<CaptureEvent> found;
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] {
    const auto is_it = [&](const CaptureEvent& event) {
      return event.time > after && std::find(kinds.begin(), kinds.end(), event.kind) != kinds.end();
    };
    const auto first = std::find_if(events_.begin(), events_.end(), is_it);
    if (first != events_.end()) found = *first;
    return found.has_value();
  });
  return found;
}

bool LiveCapture::wait_for_count(std::size_t count, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, patience, [&] { return frames_.size() >= count; });
}

std::vector<SeenFrame> LiveCapture::frames() const {
  const std::lock_guard lock(mutex_);
  return frames_;
}

std::vector<CaptureEvent> LiveCapture::events() const {
  const std::lock_guard lock(mutex_);
  return events_;
}

}  // namespace alidade::test
