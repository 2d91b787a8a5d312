// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/frame_of_buffer.h"

#include <arv.h>
#include <gtest/gtest.h>

#include "capture/genicam/camera_stream.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

// A buffer as Aravis makes it: cleared, without a header.
GObjectPointer<ArvBuffer> bare_buffer(std::size_t bytes) {
  GObjectPointer<ArvBuffer> buffer(arv_buffer_new(bytes, nullptr));
  std::fill_n(static_cast<std::uint8_t*>(const_cast<void*>(arv_buffer_get_data(buffer.get(), nullptr))), bytes, 7);
  arv_buffer_set_frame_id(buffer.get(), kNoFrameId);
  return buffer;
}

CameraSetup setup(cv::Size size) {
  CameraSetup result;
  result.facts.size = size;
  result.wire = *pfnc_format("Mono8");
  return result;
}

TEST(FrameOfBuffer, FlagsAFrameThatDidNotCompleteAndKeepsItsBytes) {
  BlockIds ids;
  const Frame frame = frame_of_buffer(bare_buffer(12).get(), 12, setup({4, 3}), ids);
  EXPECT_TRUE(frame.stamp.is_damaged);
  EXPECT_EQ(frame.image.size(), cv::Size(4, 3));
  EXPECT_EQ(frame.image.at<std::uint8_t>(2, 3), 7);
}

TEST(FrameOfBuffer, KnowsNoTimeNorIdWithoutAHeader) {
  BlockIds ids;
  const Frame frame = frame_of_buffer(bare_buffer(12).get(), 12, setup({4, 3}), ids);
  EXPECT_FALSE(frame.stamp.sequence);
  EXPECT_FALSE(frame.stamp.device_time);
  EXPECT_TRUE(frame.stamp.host_time);
}

TEST(FrameOfBuffer, HasAnEmptyImageWhereTheBufferIsTooSmall) {
  BlockIds ids;
  const Frame frame = frame_of_buffer(bare_buffer(11).get(), 11, setup({4, 3}), ids);
  EXPECT_TRUE(frame.stamp.is_damaged);
  EXPECT_TRUE(frame.image.empty());
}

TEST(HostTimeOfRealtime, TakesTheAgeOff) {
  const HostTime time = host_time_of_realtime((g_get_real_time() - 300'000) * 1000);
  const auto age = HostClock::now() - time;
  EXPECT_GE(age, 300ms);
  EXPECT_LT(age, 800ms);
}

TEST(HostTimeOfRealtime, IsNowWhereTheClockOfTheDayWasSet) {
  const HostTime before = HostClock::now();
  for (const std::int64_t ahead_s : {3600, -3600, -1'000'000'000}) {
    const HostTime time = host_time_of_realtime((g_get_real_time() + ahead_s * 1'000'000) * 1000);
    EXPECT_GE(time, before) << ahead_s;
    EXPECT_LE(time, HostClock::now()) << ahead_s;
  }
}

}  // namespace
}  // namespace alidade
