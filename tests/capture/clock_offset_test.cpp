// SPDX-License-Identifier: Apache-2.0
#include "capture/clock_offset.h"

#include <random>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

/// A camera whose clock began `lag` ago and runs `ppm` too fast, seen with delays that are mostly small.
class Camera {
 public:
  Camera(nanoseconds lag, double ppm) : lag_(lag), ppm_(ppm) {}

  HostTime host(nanoseconds since_start) const { return HostTime(seconds(5000) + since_start); }
  Timestamp device(nanoseconds since_start) const {
    return Timestamp(lag_ + from_seconds(to_seconds(since_start) * (1 + 1e-6 * ppm_)));
  }
  nanoseconds delay() { return microseconds(200) + nanoseconds(static_cast<long>(2e6 * late_(random_))); }

 private:
  nanoseconds lag_;
  double ppm_;
  std::mt19937 random_{7};
  std::exponential_distribution<double> late_{1.0};  // of 2 ms
};

TEST(ClockOffset, IsNotKnownBeforeTheFirstPair) {
  const ClockOffset clock;
  EXPECT_FALSE(clock.offset());
  EXPECT_FALSE(clock.to_host(Timestamp(seconds(1))));
}

TEST(ClockOffset, IsTheDifferenceOfTheOnlyPair) {
  ClockOffset clock;
  EXPECT_FALSE(clock.observe(Timestamp(seconds(3)), HostTime(seconds(10))));
  EXPECT_EQ(clock.offset(), seconds(7));
  EXPECT_EQ(clock.to_host(Timestamp(seconds(4))), HostTime(seconds(11)));
}

TEST(ClockOffset, FollowsAClockThatRunsFastThroughDelaysOfMilliseconds) {
  for (const double ppm : {-200.0, 0.0, 100.0}) {
    Camera camera(seconds(123), ppm);
    ClockOffset clock;
    for (int i = 0; i < 60 * 30; ++i) {
      const nanoseconds now = milliseconds(1000) * i / 30;
      ASSERT_FALSE(clock.observe(camera.device(now), camera.host(now) + camera.delay())) << i;
      if (i < 10 * 30) continue;
      const double error_s = to_seconds(*clock.to_host(camera.device(now)) - camera.host(now));
      ASSERT_GT(error_s, 0.0) << ppm << " ppm, frame " << i;
      ASSERT_LT(error_s, 0.5e-3) << ppm << " ppm, frame " << i;
    }
  }
}

TEST(ClockOffset, ForgetsAllWhenTheDeviceHasRestarted) {
  ClockOffset clock;
  clock.observe(Timestamp(seconds(100)), HostTime(seconds(200)));
  EXPECT_TRUE(clock.observe(Timestamp(seconds(1)), HostTime(seconds(203))));
  EXPECT_EQ(clock.offset(), seconds(202));
  EXPECT_TRUE(clock.observe(Timestamp(seconds(10)), HostTime(seconds(204))));  // set ahead
  EXPECT_EQ(clock.offset(), seconds(194));
}

TEST(ClockOffset, TakesALateFrameForLateOnly) {
  ClockOffset clock;
  clock.observe(Timestamp(seconds(1)), HostTime(seconds(11)));
  EXPECT_FALSE(clock.observe(Timestamp(seconds(2)), HostTime(seconds(19))));
  EXPECT_EQ(clock.to_host(Timestamp(seconds(2))), HostTime(seconds(12)));
}

}  // namespace
}  // namespace alidade
