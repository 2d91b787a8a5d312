// SPDX-License-Identifier: Apache-2.0
#include "capture/frame_queue.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/format.h>

namespace alidade {
namespace {

class FrameQueue : public FrameSource {
 public:
  FrameQueue(std::unique_ptr<FrameSource> source, QueueOptions options)
      : source_(std::move(source)),
        count_(source_->frame_count()),
        has_times_(source_->has_times()),
        description_(source_->describe()),
        options_(std::move(options)),
        reader_([this](std::stop_token stop) { read(stop); }) {}

  std::optional<Frame> next(std::stop_token stop) override {
    std::unique_lock lock(mutex_);
    if (!changed_.wait(lock, stop, [this] { return !frames_.empty() || finished_; })) return std::nullopt;
    if (frames_.empty()) {
      if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
      return std::nullopt;
    }
    Frame frame = std::move(frames_.front());
    frames_.pop_front();
    frame.stamp.discarded_before += std::exchange(discarded_, 0);
    frame.stamp.dropped_before += std::exchange(dropped_, 0);
    changed_.notify_all();
    return frame;
  }

  std::optional<int> frame_count() const override { return count_; }
  bool has_times() const override { return has_times_; }
  std::string describe() const override { return description_; }

  std::optional<std::string> fault() const override {
    const std::scoped_lock lock(mutex_);
    return finished_ && frames_.empty() ? fault_ : std::nullopt;
  }

 private:
  void read(std::stop_token stop) {
    std::exception_ptr error;
    try {
      while (auto frame = source_->next(stop)) {
        if (!push(std::move(*frame), stop)) return;
      }
    } catch (...) {
      error = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    fault_ = source_->fault();
    error_ = error;
    finished_ = true;
    changed_.notify_all();
  }

  // False where the wait for room was stopped.
  bool push(Frame frame, std::stop_token stop) {
    std::optional<CaptureEvent> event;
    {
      std::unique_lock lock(mutex_);
      const auto has_room = [this] { return frames_.size() < options_.capacity; };
      if (options_.when_full == WhenFull::Block) {
        if (!changed_.wait(lock, stop, has_room)) return false;
      } else if (!has_room()) {
        event = give_up_oldest();
      }
      frames_.push_back(std::move(frame));
      changed_.notify_all();
    }
    if (event && options_.events) options_.events(*event);
    return true;
  }

  // The frame goes, what it told of frames before it goes on to the next one.
  CaptureEvent give_up_oldest() {
    const Frame oldest = std::move(frames_.front());
    frames_.pop_front();
    discarded_ += 1 + oldest.stamp.discarded_before;
    dropped_ += oldest.stamp.dropped_before;
    return {CaptureEventKind::FramesDiscarded, HostClock::now(), description_, oldest.index,
            fmt::format("frame {}: the queue of {} is full", oldest.index, options_.capacity)};
  }

  std::unique_ptr<FrameSource> source_;  // the reader thread's alone
  const std::optional<int> count_;
  const bool has_times_;
  const std::string description_;
  const QueueOptions options_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Frame> frames_;
  std::uint64_t discarded_ = 0, dropped_ = 0;  // since the last frame taken, by us and by the device
  std::optional<std::string> fault_;
  std::exception_ptr error_;
  bool finished_ = false;
  std::jthread reader_;  // last: it uses all of the above, so it must be joined first
};

}  // namespace

std::unique_ptr<FrameSource> queued(std::unique_ptr<FrameSource> source, const QueueOptions& options) {
  if (!source || options.capacity == 0) throw std::invalid_argument("queued: a source and room for a frame are needed");
  return std::make_unique<FrameQueue>(std::move(source), options);
}

}  // namespace alidade
