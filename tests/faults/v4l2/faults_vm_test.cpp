// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <future>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "capture/v4l2/v4l2_camera.h"
#include "capture/v4l2/v4l2_controls.h"
#include "tests/faults/v4l2/live_webcam.h"
#include "tests/faults/v4l2/vivid.h"

namespace alidade::test {
namespace {

using std::chrono::milliseconds;
using Seconds = std::chrono::duration<double>;

class V4l2FaultsInTheMachine : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_vivid()) GTEST_SKIP() << "no vivid here";
  }

  /// A figure, for the record of this run.
  static void report(const std::string& name, double value) { RecordProperty(name, fmt::format("{:.6g}", value)); }
};

double seconds_between(HostTime from, HostTime to) {
  return Seconds(to - from).count();
}

TEST_F(V4l2FaultsInTheMachine, CountTheFramesThatTheDriverDrops) {
  const WebcamReset reset;
  const int frames = parameter("ALIDADE_DROP_FRAMES", 300);
  LiveWebcam camera(60);
  set_control(kWebcam, "percentage_of_dropped_buffers", "10");
  std::uint64_t dropped = 0;
  std::set<std::uint64_t> came;  // vivid counts a frame twice at times, when the machine holds it up
  for (int i = 0; i < frames; ++i) {
    const auto frame = camera.next();
    ASSERT_TRUE(frame);
    if (i > 0) dropped += frame->stamp.dropped_before;
    came.insert(frame->stamp.sequence.value());
  }
  const std::uint64_t missing = *came.rbegin() - *came.begin() + 1 - came.size();
  EXPECT_EQ(dropped, missing);
  EXPECT_GT(dropped, static_cast<std::uint64_t>(frames) / 20);
  EXPECT_GT(camera.count(CaptureEventKind::FramesDropped), 0);
  report("v4l2_drop_frames", frames);
  report("v4l2_drop_reported", static_cast<double>(dropped));
  report("v4l2_drop_sequence_gaps", static_cast<double>(missing));
}

TEST_F(V4l2FaultsInTheMachine, FlagEveryBufferWithAnError) {
  LiveWebcam camera;
  ASSERT_TRUE(camera.read(3));
  constexpr int kInjected = 5;
  int flagged = 0;
  for (int i = 0; i < kInjected; ++i) {
    set_control(kWebcam, "inject_v4l2_buf_flag_error", "1");
    for (int k = 0; k < 12; ++k) {
      const auto frame = camera.next();
      ASSERT_TRUE(frame);
      flagged += frame->stamp.is_damaged;
    }
  }
  EXPECT_EQ(flagged, kInjected);
  EXPECT_EQ(camera.count(CaptureEventKind::FrameDamaged), kInjected);
  report("v4l2_buffer_errors_injected", kInjected);
  report("v4l2_buffer_errors_flagged", flagged);
}

TEST_F(V4l2FaultsInTheMachine, MakeOneClearErrorOfARefusedStart) {
  const int before = open_descriptors();
  for (const char* fault :
       {"inject_vidioc_reqbufs_error", "inject_vidioc_qbuf_error", "inject_vidioc_streamon_error"}) {
    set_control(kWebcam, fault, "1");
    try {
      open_v4l2(kWebcam, small_request());
      ADD_FAILURE() << fault << " went unseen";
    } catch (const CameraError& error) {
      EXPECT_EQ(error.trouble(), CameraTrouble::Refused) << error.what();
      EXPECT_EQ(std::string(error.what()).rfind("/dev/video0: ", 0), 0U) << error.what();
    }
    EXPECT_TRUE(open_v4l2(kWebcam, small_request())->wait(std::chrono::seconds(2))) << fault;
  }
  EXPECT_EQ(open_descriptors(), before);
}

TEST_F(V4l2FaultsInTheMachine, LoseNothingWhenABufferIsNotTakenBack) {
  LiveWebcam camera;
  ASSERT_TRUE(camera.read(3));
  for (int i = 0; i < 12; ++i) {  // more often than there are buffers
    set_control(kWebcam, "inject_vidioc_qbuf_error", "1");
    ASSERT_TRUE(camera.read(3));
  }
  EXPECT_EQ(camera.count(CaptureEventKind::Stalled), 0);
  EXPECT_EQ(camera.count(CaptureEventKind::Disconnected), 0);
}

TEST_F(V4l2FaultsInTheMachine, CarryTheCountOverItsWrap) {
  const WebcamReset reset;
  set_control(kWebcam, "wrap_sequence_number", "on");
  LiveWebcam camera(60);
  std::uint64_t dropped = 0;
  int counted_twice = 0;  // by vivid, when the machine holds it up
  std::set<std::uint64_t> came;
  for (int i = 0; i < 200; ++i) {
    const auto frame = camera.next();
    ASSERT_TRUE(frame);
    dropped += frame->stamp.dropped_before;
    counted_twice += !came.insert(frame->stamp.sequence.value()).second;
  }
  EXPECT_GT(*came.rbegin(), 0xffff'0000U);
  EXPECT_LT(*came.begin(), 0x1'0000U);
  EXPECT_LT(dropped, 100U);  // not four milliards
  EXPECT_EQ(camera.count(CaptureEventKind::Restarted), counted_twice);
}

TEST_F(V4l2FaultsInTheMachine, AreOverSoonAfterAFatalError) {
  LiveWebcam camera;
  ASSERT_TRUE(camera.read(5));
  const HostTime begin = HostClock::now();
  set_control(kWebcam, "inject_fatal_streaming_error", "1");
  const auto lost = camera.read_past(CaptureEventKind::Disconnected, begin);
  ASSERT_TRUE(lost);
  const auto again = camera.find(CaptureEventKind::Streaming, lost->time);
  ASSERT_TRUE(again);
  report("v4l2_fatal_event_s", seconds_between(begin, lost->time));
  report("v4l2_fatal_streaming_again_s", seconds_between(lost->time, again->time));
  EXPECT_LE(seconds_between(begin, again->time), 1);
}

TEST_F(V4l2FaultsInTheMachine, AreToldWhenFramesStall) {
  const WebcamReset reset;
  const double fps_hz = 30;
  LiveWebcam camera(fps_hz);
  double slowest_s = 0;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(camera.read(10));
    const HostTime begin = HostClock::now();
    set_control(kWebcam, "percentage_of_dropped_buffers", "100");
    const auto wake = std::async(std::launch::async, [] {
      std::this_thread::sleep_for(milliseconds(500));
      set_control(kWebcam, "percentage_of_dropped_buffers", "0");
    });
    HostTime last = camera.last_frame_time();
    while (!camera.find(CaptureEventKind::Stalled, begin)) {
      last = camera.last_frame_time();
      ASSERT_TRUE(camera.next());
    }
    slowest_s = std::max(slowest_s, seconds_between(last, camera.find(CaptureEventKind::Stalled, begin)->time));
    EXPECT_TRUE(camera.find(CaptureEventKind::Resumed, begin));
  }
  report("v4l2_stall_event_s", slowest_s);
  report("v4l2_stall_bound_s", std::max(5 / fps_hz, 0.25));
  EXPECT_LE(slowest_s, std::max(5 / fps_hz, 0.25));
}

/// What one unplugging took.
struct Unplugging {
  double event_s = 0;  ///< from the last frame
  double back_s = 0;   ///< from the return of the device to its first frame
};

/// Pulls the plug after `delay`, while the camera is being read. vivid comes back when the last opening of it is
/// closed: one of ours keeps it away for a while. Returns when it was back.
HostTime pull_plug(milliseconds delay) {
  auto holder = std::make_unique<V4l2Device>(kWebcam);
  std::this_thread::sleep_for(delay);
  set_v4l2_control(*holder, "disconnect", "1");
  std::this_thread::sleep_for(milliseconds(300));
  holder.reset();
  return HostClock::now();
}

std::optional<Unplugging> unplug(LiveWebcam& camera, milliseconds delay) {
  if (!camera.read(5)) return std::nullopt;
  const HostTime begin = HostClock::now();
  auto plugged_in = std::async(std::launch::async, pull_plug, delay);
  HostTime last = begin;
  while (!camera.find(CaptureEventKind::Disconnected, begin)) {
    last = camera.last_frame_time();
    if (!camera.next()) return std::nullopt;
  }
  const HostTime back = plugged_in.get();
  const auto again = camera.find(CaptureEventKind::Streaming, begin);
  if (!again) return std::nullopt;
  return Unplugging{seconds_between(last, camera.find(CaptureEventKind::Disconnected, begin)->time),
                    seconds_between(back, again->time)};
}

TEST_F(V4l2FaultsInTheMachine, AreOverSoonAfterTheCameraIsPluggedInAgain) {
  const int cycles = parameter("ALIDADE_CYCLES", 5);
  const double fps_hz = 30;
  LiveWebcam camera(fps_hz);
  ASSERT_TRUE(unplug(camera, milliseconds(10)));  // what is made at the first use is no leak
  const int descriptors = open_descriptors();
  const int memory_kb = resident_kb();
  int recovered = 0, in_time = 0;
  double slowest_event_s = 0, slowest_back_s = 0;
  for (int i = 0; i < cycles; ++i) {
    const auto told = unplug(camera, milliseconds(20 + 7 * i % 33));  // at all phases of the period
    if (!told) continue;
    ++recovered;
    slowest_event_s = std::max(slowest_event_s, told->event_s);
    slowest_back_s = std::max(slowest_back_s, told->back_s);
    in_time += told->event_s <= 2 / fps_hz && told->back_s <= 1;
  }
  report("v4l2_unplug_cycles", cycles);
  report("v4l2_unplug_recovered", recovered);
  report("v4l2_unplug_in_time", in_time);
  report("v4l2_unplug_event_periods", slowest_event_s * fps_hz);
  report("v4l2_unplug_streaming_again_s", slowest_back_s);
  report("v4l2_unplug_more_descriptors", open_descriptors() - descriptors);
  report("v4l2_unplug_more_memory_kb", resident_kb() - memory_kb);
  EXPECT_EQ(recovered, cycles);
  EXPECT_LE(slowest_event_s, 2 / fps_hz);
  EXPECT_LE(slowest_back_s, 1);
  EXPECT_EQ(open_descriptors(), descriptors);
  EXPECT_LE(resident_kb() - memory_kb, 1024);
}

}  // namespace
}  // namespace alidade::test
