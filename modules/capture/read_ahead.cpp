// SPDX-License-Identifier: Apache-2.0
#include "capture/read_ahead.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

namespace alidade {
namespace {

class ReadAhead : public FrameSource {
 public:
  ReadAhead(std::unique_ptr<FrameSource> source, std::size_t capacity)
      : source_(std::move(source)),
        count_(source_->frame_count()),
        has_times_(source_->has_times()),
        description_(source_->describe()),
        capacity_(capacity),
        reader_([this](std::stop_token stop) { read(stop); }) {}

  std::optional<Frame> next() override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !frames_.empty() || finished_; });
    if (frames_.empty()) {
      if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
      return std::nullopt;
    }
    Frame frame = std::move(frames_.front());
    frames_.pop_front();
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
      while (auto frame = source_->next()) {
        std::unique_lock lock(mutex_);
        if (!changed_.wait(lock, stop, [this] { return frames_.size() < capacity_; })) return;
        frames_.push_back(std::move(*frame));
        changed_.notify_all();
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

  std::unique_ptr<FrameSource> source_;  // the reader thread's alone
  const std::optional<int> count_;
  const bool has_times_;
  const std::string description_;
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Frame> frames_;
  std::optional<std::string> fault_;
  std::exception_ptr error_;
  bool finished_ = false;
  std::jthread reader_;  // last: it uses all of the above, so it must be joined first
};

}  // namespace

std::unique_ptr<FrameSource> read_ahead(std::unique_ptr<FrameSource> source, std::size_t capacity) {
  if (!source || capacity == 0) throw std::invalid_argument("read_ahead: a source and room for a frame are needed");
  return std::make_unique<ReadAhead>(std::move(source), capacity);
}

}  // namespace alidade
