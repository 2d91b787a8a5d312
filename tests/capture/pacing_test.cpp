// SPDX-License-Identifier: Apache-2.0
#include "capture/pacing.h"

#include <thread>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using std::chrono::milliseconds;

class Ticks : public FrameSource {
 public:
  Ticks(int count, bool timed) : count_(count), timed_(timed) {}
  std::optional<Frame> next(std::stop_token) override {
    if (next_ == count_) return std::nullopt;
    Frame frame;
    frame.index = next_;
    frame.time = Timestamp(std::chrono::seconds(500) + milliseconds(30) * next_++);
    return frame;
  }
  std::optional<int> frame_count() const override { return count_; }
  bool has_times() const override { return timed_; }
  std::string describe() const override { return "ticks"; }
  std::optional<std::string> fault() const override { return "worn"; }

 private:
  int count_, next_ = 0;
  bool timed_;
};

TEST(InRealTime, GivesNoFrameEarlierThanItCame) {
  const auto source = in_real_time(std::make_unique<Ticks>(5, true));
  EXPECT_EQ(source->frame_count(), 5);
  EXPECT_EQ(source->describe(), "ticks");
  EXPECT_EQ(source->fault(), "worn");
  const HostTime start = HostClock::now();
  int count = 0;
  for (; const auto frame = source->next(); ++count) {
    EXPECT_EQ(frame->index, count);
    EXPECT_GE(HostClock::now() - start, milliseconds(30) * count - milliseconds(1));
  }
  EXPECT_EQ(count, 5);
}

TEST(InRealTime, LeavesNoFrameOutForASlowReader) {
  const auto source = in_real_time(std::make_unique<Ticks>(3, true));
  source->next();
  std::this_thread::sleep_for(milliseconds(80));
  const auto start = HostClock::now();
  EXPECT_EQ(source->next()->index, 1);
  EXPECT_EQ(source->next()->index, 2);
  EXPECT_LT(HostClock::now() - start, milliseconds(25));
}

TEST(InRealTime, DoesNotWaitWithoutTimes) {
  const auto source = in_real_time(std::make_unique<Ticks>(40, false));
  const auto start = HostClock::now();
  while (source->next()) {
  }
  EXPECT_LT(HostClock::now() - start, milliseconds(500));
}

TEST(InRealTime, EndsItsWaitWhenStopped) {
  const auto source = in_real_time(std::make_unique<Ticks>(3, true));
  std::stop_source stop;
  source->next(stop.get_token());
  stop.request_stop();
  EXPECT_FALSE(source->next(stop.get_token()));
  EXPECT_EQ(source->next()->index, 1) << "a frame was lost by the stop";
}

}  // namespace
}  // namespace alidade
