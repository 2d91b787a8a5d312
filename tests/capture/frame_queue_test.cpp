// SPDX-License-Identifier: Apache-2.0
#include "capture/frame_queue.h"

#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "core/errors.h"

namespace alidade {
namespace {

/// Counts to `count`, then ends, or throws where `broken`.
class Counter : public FrameSource {
 public:
  Counter(int count, bool broken, std::atomic<int>* given) : count_(count), broken_(broken), given_(given) {}
  std::optional<Frame> next(std::stop_token) override {
    if (next_ == count_ && broken_) throw InputError("frame.jpg", 0, "damaged", "");
    if (next_ == count_) return std::nullopt;
    ++*given_;
    Frame frame{next_++, {}, "", cv::Mat(1, 1, CV_8U)};
    frame.stamp.dropped_before = frame.index > 0;
    return frame;
  }
  std::optional<int> frame_count() const override { return count_; }
  bool has_times() const override { return true; }
  std::string describe() const override { return "a counter"; }
  std::optional<std::string> fault() const override { return "cut off"; }

 private:
  int count_;
  bool broken_;
  std::atomic<int>* given_;
  int next_ = 0;
};

TEST(FrameQueue, KeepsTheOrderAndTheFacts) {
  std::atomic<int> given = 0;
  const auto source = queued(std::make_unique<Counter>(100, false, &given), {3});
  EXPECT_EQ(source->frame_count(), 100);
  EXPECT_TRUE(source->has_times());
  EXPECT_EQ(source->describe(), "a counter");
  for (int i = 0; i < 100; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
  }
  EXPECT_FALSE(source->next());
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->fault(), "cut off");
}

TEST(FrameQueue, ThrowsInTheirPlaceTheErrorsOfTheSource) {
  std::atomic<int> given = 0;
  const auto source = queued(std::make_unique<Counter>(5, true, &given), {3});
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(source->next());
  EXPECT_THROW(source->next(), InputError);
  EXPECT_FALSE(source->next());
}

TEST(FrameQueue, StopsAtItsCapacityAndWhenItDies) {
  std::atomic<int> given = 0;
  {
    const auto source = queued(std::make_unique<Counter>(1000, false, &given), {4});
    ASSERT_TRUE(source->next());
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_LE(given, 6);  // one taken, four queued, one waiting for room
  }
  EXPECT_LE(given, 6);
}

TEST(FrameQueue, GivesUpTheOldestWhereItIsToldToAndCountsThem) {
  std::atomic<int> given = 0;
  std::atomic<int> events = 0;
  QueueOptions options{2, WhenFull::DropOldest,
                       [&](const CaptureEvent& event) { events += event.kind == CaptureEventKind::FramesDiscarded; }};
  const auto source = queued(std::make_unique<Counter>(100, false, &given), options);
  while (events < 98) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const auto newest_but_one = source->next();
  EXPECT_EQ(newest_but_one->index, 98);
  EXPECT_EQ(newest_but_one->stamp.discarded_before, 98u);
  EXPECT_EQ(newest_but_one->stamp.dropped_before, 98u);  // one before each
  EXPECT_EQ(source->next()->stamp.discarded_before, 0u);
}

TEST(FrameQueue, LetsGoOfAWaitingReaderWhoIsToldToStop) {
  class Silence : public Counter {
   public:
    using Counter::Counter;
    std::optional<Frame> next(std::stop_token stop) override {
      while (!stop.stop_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return std::nullopt;
    }
  };
  std::atomic<int> given = 0;
  const auto source = queued(std::make_unique<Silence>(1, false, &given));
  std::stop_source stop;
  std::jthread asker([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    stop.request_stop();
  });
  EXPECT_FALSE(source->next(stop.get_token()));
}

TEST(FrameQueue, NeedsASourceAndRoom) {
  std::atomic<int> given = 0;
  EXPECT_THROW(queued(nullptr), std::invalid_argument);
  EXPECT_THROW(queued(std::make_unique<Counter>(1, false, &given), {0}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
