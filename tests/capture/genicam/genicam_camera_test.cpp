// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/genicam_camera.h"

#include <filesystem>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "capture/genicam/background_release.h"
#include "fake_camera_process.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

long entries_of(const char* directory) {
  const std::filesystem::directory_iterator all(directory);
  return std::distance(begin(all), end(all));
}

HostClock::duration time_of(const std::function<void()>& action) {
  const HostTime start = HostClock::now();
  action();
  return HostClock::now() - start;
}

class GenicamCamera : public testing::Test {
 protected:
  void SetUp() override {
    if (!process_.is_running()) GTEST_SKIP() << "no camera on loopback";
    request_.size = cv::Size(320, 240);
    request_.fps_hz = 100;
  }

  std::unique_ptr<CameraDevice> open() const { return open_genicam(FakeCameraProcess::address(), request_); }

  // Until the camera takes us, but five seconds at most.
  std::unique_ptr<CameraDevice> open_again() const {
    for (int i = 0; i < 25; ++i) {
      try {
        return open();
      } catch (const CameraError&) {
        std::this_thread::sleep_for(200ms);
      }
    }
    return open();
  }

  FakeCameraProcess process_;
  CameraRequest request_;
};

TEST_F(GenicamCamera, GivesFramesThatFollowEachOther) {
  const auto camera = open();
  auto last = camera->wait(2s);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->image.size(), cv::Size(320, 240));
  for (int i = 0; i < 40; ++i) {
    const auto frame = camera->wait(2s);
    ASSERT_TRUE(frame);
    EXPECT_FALSE(frame->stamp.is_damaged);
    EXPECT_EQ(*frame->stamp.sequence, *last->stamp.sequence + 1);
    EXPECT_GT(*frame->stamp.device_time, *last->stamp.device_time);
    EXPECT_EQ(frame->time, *frame->stamp.device_time);
    EXPECT_LE(*frame->stamp.host_time, HostClock::now());
    EXPECT_GT(*frame->stamp.host_time, HostClock::now() - 1s);
    last = frame;
  }
}

TEST_F(GenicamCamera, StampsByTheHostsClockAsFastAsByTheCameras) {
  const auto camera = open();
  const auto first = camera->wait(2s);
  auto last = first;
  for (int i = 0; i < 50 && last; ++i) last = camera->wait(2s);
  ASSERT_TRUE(last);
  const auto by_camera = *last->stamp.device_time - *first->stamp.device_time;
  const auto by_host = *last->stamp.host_time - *first->stamp.host_time;
  EXPECT_NEAR(std::chrono::duration<double>(by_camera).count(), std::chrono::duration<double>(by_host).count(), 0.05);
}

TEST_F(GenicamCamera, GivesNothingWhereNoFrameComesInTime) {
  request_.trigger = CameraTrigger::Hardware;  // a signal that never comes
  const auto camera = open();
  const auto waited = time_of([&] { EXPECT_FALSE(camera->wait(100ms)); });
  EXPECT_GE(waited, 100ms);
  EXPECT_LT(waited, 600ms);
}

TEST_F(GenicamCamera, ExposesWhenTheHostSaysSo) {
  request_.fps_hz = 10;  // this camera looks for triggers but 25 times a second
  request_.trigger = CameraTrigger::Software;
  const auto camera = open();
  EXPECT_EQ(camera->facts().period, 100ms);
  ASSERT_TRUE(camera->wait(2s));
  const auto taken = time_of([&] {
    for (int i = 0; i < 8; ++i) EXPECT_TRUE(camera->wait(2s));
  });
  EXPECT_GT(taken, 650ms);
  EXPECT_LT(taken, 1200ms);
}

TEST_F(GenicamCamera, IsBusyForASecondProgram) {
  const auto camera = open();
  try {
    open();
    FAIL();
  } catch (const CameraError& error) {
    EXPECT_EQ(error.trouble(), CameraTrouble::Busy);
    EXPECT_STREQ(error.what(),
                 "genicam:127.0.0.1: open: another program controls the camera; end it; after a crash the camera lets "
                 "go within a few seconds");
  }
  EXPECT_TRUE(camera->wait(2s));
}

TEST_F(GenicamCamera, LeavesNothingBehind) {
  open();
  const long files = entries_of("/proc/self/fd"), threads = entries_of("/proc/self/task");
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(open()->wait(2s));
  EXPECT_EQ(entries_of("/proc/self/fd"), files);
  EXPECT_EQ(entries_of("/proc/self/task"), threads);
}

TEST_F(GenicamCamera, IsGivenUpAtOnceWhenDeadAndOpensOnceItIsBack) {
  auto camera = open();
  ASSERT_TRUE(camera->wait(2s));
  process_.kill();
  EXPECT_LT(time_of([&] { camera.reset(); }), 500ms);
  EXPECT_EQ(background_releases(), 1);
  EXPECT_LT(time_of([&] { EXPECT_THROW(open(), CameraError); }), 500ms);
  process_.restart();
  EXPECT_LT(time_of([&] { camera = open_again(); }), 1s);
  EXPECT_TRUE(camera->wait(2s));
}

TEST_F(GenicamCamera, SaysThatItIsGoneOnceAnotherHasReplacedIt) {
  const auto camera = open();
  ASSERT_TRUE(camera->wait(2s));
  process_.restart();
  const auto until_gone = [&] {
    for (int i = 0; i < 40; ++i) camera->wait(100ms);
  };
  try {
    until_gone();
    FAIL();
  } catch (const CameraError& error) {
    EXPECT_EQ(error.trouble(), CameraTrouble::Gone);
  }
}

TEST_F(GenicamCamera, OpensAgainWhenACameraThatStoodStillGoesOn) {
  auto camera = open();
  ASSERT_TRUE(camera->wait(2s));
  process_.stop();
  EXPECT_LT(time_of([&] { camera.reset(); }), 500ms);
  EXPECT_THROW(open(), CameraError);
  process_.go_on();
  camera = open_again();
  EXPECT_TRUE(camera->wait(2s));
}

TEST(GenicamCameraOnALossyNetwork, FlagsAndCountsWhatIsIncomplete) {
  const FakeCameraProcess process(30);
  if (!process.is_running()) GTEST_SKIP() << "no camera on loopback";
  CameraRequest request;
  request.fps_hz = 200;
  request.packet_size = 1400;
  const auto camera = open_genicam(process.address(), request);
  std::uint64_t damaged = 0, headless = 0, last = 0;
  for (int i = 0; i < 150; ++i) {
    const auto frame = camera->wait(2s);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->image.size(), camera->facts().size);
    damaged += frame->stamp.is_damaged ? 1 : 0;
    headless += frame->stamp.sequence ? 0 : 1;
    if (frame->stamp.sequence) {
      EXPECT_GT(*frame->stamp.sequence, last);
      last = *frame->stamp.sequence;
    }
  }
  EXPECT_GT(damaged, 120u);  // of 190 packets 3 % are lost, and this camera never sends one again
  EXPECT_GT(headless, 0u);   // the header is one of the packets
  const auto statistics = camera->statistics();
  EXPECT_EQ(statistics[1].first, "damaged frames");
  EXPECT_GE(statistics[1].second, damaged);
  EXPECT_EQ(statistics[4].first, "missing packets");
  EXPECT_GT(statistics[4].second, 0u);
}

}  // namespace
}  // namespace alidade
