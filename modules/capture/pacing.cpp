// SPDX-License-Identifier: Apache-2.0
#include "capture/pacing.h"

#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace alidade {
namespace {

class Paced : public FrameSource {
 public:
  explicit Paced(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

  std::optional<Frame> next(std::stop_token stop) override {
    if (!pending_) pending_ = source_->next(stop);
    if (!pending_) return std::nullopt;
    if (!first_time_) {
      first_time_ = pending_->time;
      start_ = HostClock::now();
    }
    if (has_times() && !wait_until(start_ + (pending_->time - *first_time_), stop)) return std::nullopt;
    return std::exchange(pending_, std::nullopt);
  }

  std::optional<int> frame_count() const override { return source_->frame_count(); }
  bool has_times() const override { return source_->has_times(); }
  std::string describe() const override { return source_->describe(); }
  std::optional<std::string> fault() const override { return source_->fault(); }

 private:
  // False where a stop was requested first.
  static bool wait_until(HostTime time, const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    never.wait_until(lock, stop, time, [] { return false; });
    return !stop.stop_requested();
  }

  std::unique_ptr<FrameSource> source_;
  std::optional<Frame> pending_;  // kept where its wait was stopped
  std::optional<Timestamp> first_time_;
  HostTime start_{};
};

}  // namespace

std::unique_ptr<FrameSource> in_real_time(std::unique_ptr<FrameSource> source) {
  if (!source) throw std::invalid_argument("in_real_time: a source is needed");
  return std::make_unique<Paced>(std::move(source));
}

}  // namespace alidade
