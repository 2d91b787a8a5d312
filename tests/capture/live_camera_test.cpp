// SPDX-License-Identifier: Apache-2.0
#include "capture/live_camera.h"

#include <algorithm>
#include <deque>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using Kind = CaptureEventKind;

/// What a camera does next: gives a frame, is silent for a while, or is gone.
struct Act {
  std::optional<std::uint64_t> sequence{};
  nanoseconds silence{};
  bool is_gone = false;
  bool is_damaged = false;
  std::optional<Timestamp> device_time{};
};

Act frame(std::uint64_t sequence) {
  return {sequence};
}
Act silence(nanoseconds duration) {
  return {std::nullopt, duration};
}
Act gone() {
  return {std::nullopt, {}, true};
}

class PlayedCamera : public CameraDevice {
 public:
  PlayedCamera(CameraFacts facts, std::deque<Act> acts) : facts_(std::move(facts)), acts_(std::move(acts)) {}

  const CameraFacts& facts() const override { return facts_; }

  std::optional<Frame> wait(nanoseconds timeout) override {
    if (acts_.empty()) return silent(timeout);
    Act& act = acts_.front();
    if (act.is_gone) throw CameraError(CameraTrouble::Gone, "played", "is gone", "unplugged", "plug it in");
    if (!act.sequence) {
      const nanoseconds passed = std::min(timeout, act.silence);
      act.silence -= passed;
      if (act.silence == nanoseconds(0)) acts_.pop_front();
      return silent(passed);
    }
    Frame result;
    result.image = cv::Mat(2, 2, CV_8UC1);
    result.stamp.sequence = act.sequence;
    result.stamp.is_damaged = act.is_damaged;
    result.stamp.device_time = act.device_time;
    acts_.pop_front();
    std::this_thread::sleep_for(milliseconds(1));
    return result;
  }

 private:
  static std::optional<Frame> silent(nanoseconds duration) {
    std::this_thread::sleep_for(duration);
    return std::nullopt;
  }

  CameraFacts facts_;
  std::deque<Act> acts_;
};

/// One script per opening; an empty one refuses to open.
class LiveCameraTest : public testing::Test {
 protected:
  LiveCameraTest() {
    facts_.size = {2, 2};
    facts_.period = milliseconds(1);
    // Long beside what a busy machine may delay a frame, short beside a test's patience.
    options_ = {.least_stall_s = 0.15, .first_frame_s = 0.1, .reopen_after_s = 0.1, .retry_s = 0.01};
  }

  std::unique_ptr<FrameSource> open(std::vector<std::deque<Act>> scripts) {
    scripts_.assign(scripts.begin(), scripts.end());
    return open_live_camera(
        "played", [this]() -> std::unique_ptr<CameraDevice> { return play(); }, options_,
        [this](const CaptureEvent& event) { events_.push_back(event); });
  }

  std::unique_ptr<CameraDevice> play() {
    std::deque<Act> script = scripts_.empty() ? std::deque<Act>{} : scripts_.front();
    if (!scripts_.empty()) scripts_.pop_front();
    if (script.empty()) throw CameraError(CameraTrouble::Busy, "played", "cannot be opened", "in use", "wait");
    return std::make_unique<PlayedCamera>(facts_, std::move(script));
  }

  std::vector<Kind> kinds() const {
    std::vector<Kind> result;
    for (const CaptureEvent& event : events_) result.push_back(event.kind);
    return result;
  }

  CameraFacts facts_;
  LiveCameraOptions options_;
  std::deque<std::deque<Act>> scripts_;
  std::vector<CaptureEvent> events_;
};

TEST_F(LiveCameraTest, CountsFramesAndWhatTheDeviceDropped) {
  const auto camera = open({{frame(7), frame(8), frame(11)}});
  EXPECT_EQ(camera->next()->stamp.dropped_before, 0u);  // nothing is known of before
  EXPECT_EQ(camera->next()->stamp.dropped_before, 0u);
  const auto third = camera->next();
  EXPECT_EQ(third->stamp.dropped_before, 2u);
  EXPECT_EQ(third->index, 2);
  EXPECT_EQ(third->name, "played#2");
  EXPECT_EQ(kinds(), (std::vector{Kind::Opened, Kind::Streaming, Kind::FramesDropped}));
}

TEST_F(LiveCameraTest, GoesOnBehindTheWrapOfA32BitCount) {
  const auto camera = open({{frame(0xfffffffe), frame(1)}});
  camera->next();
  EXPECT_EQ(camera->next()->stamp.dropped_before, 2u);  // 0xffffffff and 0
}

TEST_F(LiveCameraTest, TellsOfADeviceThatCountsAnew) {
  const auto camera = open({{frame(50'000), frame(0), frame(1)}});
  for (int i = 0; i < 3; ++i) EXPECT_EQ(camera->next()->stamp.dropped_before, 0u);
  EXPECT_EQ(kinds(), (std::vector{Kind::Opened, Kind::Streaming, Kind::Restarted}));
}

TEST_F(LiveCameraTest, TakesACountThatComesTwiceForNoFault) {
  const auto camera = open({{frame(5), frame(5), frame(6)}});
  for (int i = 0; i < 3; ++i) EXPECT_EQ(camera->next()->stamp.dropped_before, 0u);
  EXPECT_EQ(kinds(), (std::vector{Kind::Opened, Kind::Streaming}));
}

TEST_F(LiveCameraTest, FlagsDamage) {
  const auto camera = open({{Act{1, {}, false, true}}});
  EXPECT_TRUE(camera->next()->stamp.is_damaged);
  EXPECT_EQ(kinds().back(), Kind::FrameDamaged);
}

TEST_F(LiveCameraTest, ComesBackAfterAnUnplug) {
  const auto camera = open({{frame(0), frame(1), gone()}, {}, {}, {frame(0)}});
  EXPECT_EQ(camera->next()->index, 0);
  EXPECT_EQ(camera->next()->index, 1);
  const auto back = camera->next();
  EXPECT_EQ(back->index, 2);
  EXPECT_EQ(back->stamp.dropped_before, 0u);
  // Two refusals of one kind are one event.
  EXPECT_EQ(kinds(), (std::vector{Kind::Opened, Kind::Streaming, Kind::Disconnected, Kind::InUse, Kind::Opened,
                                  Kind::Streaming}));
  EXPECT_EQ(events_[2].frame, 2);
}

TEST_F(LiveCameraTest, TellsOfAStallInTimeAndOfItsEnd) {
  const auto camera = open({{frame(0), silence(milliseconds(220)), frame(40)}});
  camera->next();
  const HostTime last = HostClock::now();
  camera->next();
  ASSERT_EQ(kinds(), (std::vector{Kind::Opened, Kind::Streaming, Kind::Stalled, Kind::Resumed, Kind::FramesDropped}));
  EXPECT_GE(events_[2].time - last, milliseconds(145));
}

TEST_F(LiveCameraTest, OpensAnewACameraThatStaysSilent) {
  const auto camera = open({{frame(0), silence(std::chrono::hours(1))}, {frame(0)}});
  camera->next();
  EXPECT_EQ(camera->next()->index, 1);
  EXPECT_EQ(kinds(), (std::vector{Kind::Opened, Kind::Streaming, Kind::Stalled, Kind::Opened, Kind::Streaming}));
}

TEST_F(LiveCameraTest, TakesTheRestOfACutOffFrameForNoSignOfLife) {
  Act rest = frame(1);
  rest.is_damaged = true;
  const auto camera = open({{frame(0), silence(milliseconds(190)), rest, silence(std::chrono::hours(1))}, {frame(0)}});
  camera->next();
  EXPECT_TRUE(camera->next()->stamp.is_damaged);
  EXPECT_FALSE(camera->next()->stamp.is_damaged);
  EXPECT_EQ(kinds(), (std::vector{Kind::Opened, Kind::Streaming, Kind::Stalled, Kind::FrameDamaged, Kind::Opened,
                                  Kind::Streaming}));
}

TEST_F(LiveCameraTest, TakesACameraThatNeverStartsForStalled) {
  const auto camera = open({{silence(std::chrono::hours(1))}, {frame(0)}});
  EXPECT_TRUE(camera->next());
  EXPECT_EQ(kinds(), (std::vector{Kind::Opened, Kind::Stalled, Kind::Opened, Kind::Streaming}));
}

TEST_F(LiveCameraTest, WaitsWithoutComplaintForATrigger) {
  options_.is_triggered = true;
  const auto camera = open({{frame(0), silence(milliseconds(500)), frame(1)}});
  camera->next();
  EXPECT_EQ(camera->next()->index, 1);
  EXPECT_EQ(kinds(), (std::vector{Kind::Opened, Kind::Streaming}));
}

TEST_F(LiveCameraTest, EndsSoonWhenItIsAskedTo) {
  const auto camera = open({{silence(std::chrono::hours(1))}});
  std::stop_source stop;
  std::jthread asker([&] {
    std::this_thread::sleep_for(milliseconds(30));
    stop.request_stop();
  });
  const HostTime begin = HostClock::now();
  EXPECT_FALSE(camera->next(stop.get_token()));
  EXPECT_LT(HostClock::now() - begin, milliseconds(500));
}

TEST_F(LiveCameraTest, GivesUpAfterTheTimeSet) {
  options_.give_up_s = 0.4;
  const auto camera = open({{frame(0), gone()}});
  camera->next();
  try {
    camera->next();
    FAIL() << "no error";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("in use"), std::string::npos) << error.what();
  }
}

TEST_F(LiveCameraTest, ThrowsWhatTheFirstOpeningThrows) {
  EXPECT_THROW(open({{}}), CameraError);
}

TEST_F(LiveCameraTest, PutsTheTimeIntoTheMiddleOfTheExposure) {
  facts_.is_host_clock = true;
  facts_.exposure = milliseconds(10);
  Act act = frame(0);
  act.device_time = Timestamp(std::chrono::seconds(100));
  facts_.stamped = StampedMoment::ExposureStart;
  EXPECT_EQ(open({{act}})->next()->time, Timestamp(milliseconds(100'005)));
  facts_.stamped = StampedMoment::ReadoutEnd;
  EXPECT_EQ(open({{act}})->next()->time, Timestamp(milliseconds(99'995)));
  facts_.stamped = StampedMoment::Unknown;
  EXPECT_EQ(open({{act}})->next()->time, Timestamp(milliseconds(100'000)));
}

TEST_F(LiveCameraTest, PutsTheTimesOfACameraWithItsOwnClockOnTheHosts) {
  Act act = frame(0);
  act.device_time = Timestamp(milliseconds(5));
  const auto camera = open({{act}});
  const auto taken = camera->next();
  EXPECT_EQ(taken->time.time_since_epoch(), taken->stamp.host_time->time_since_epoch());
}

// It was seen when the exposure was over, so the middle is half an exposure earlier.
TEST_F(LiveCameraTest, KnowsThatAFrameIsSentAfterItsExposure) {
  facts_.exposure = milliseconds(10);
  facts_.stamped = StampedMoment::ExposureStart;
  Act act = frame(0);
  act.device_time = Timestamp(milliseconds(5));
  const auto camera = open({{act}});
  const auto taken = camera->next();
  EXPECT_EQ(taken->time.time_since_epoch(), taken->stamp.host_time->time_since_epoch() - milliseconds(5));
}

TEST(LiveCameraOptions, NameWhatIsOutOfBounds) {
  EXPECT_NO_THROW(validate(LiveCameraOptions{}));
  EXPECT_THROW(validate(LiveCameraOptions{.stall_periods = 1}), std::invalid_argument);
  EXPECT_THROW(validate(LiveCameraOptions{.retry_s = 0}), std::invalid_argument);
  EXPECT_THROW(validate(LiveCameraOptions{.give_up_s = 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
