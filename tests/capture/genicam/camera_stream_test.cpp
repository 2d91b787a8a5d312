// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/camera_stream.h"

#include <arv.h>
#include <gtest/gtest.h>

#include "capture/genicam/camera_opening.h"
#include "fake_camera_process.h"

namespace alidade {
namespace {

using namespace std::chrono_literals;

int free_buffers(ArvStream* stream) {
  int free = 0, filled = 0;
  arv_stream_get_n_buffers(stream, &free, &filled);
  return free;
}

TEST(CameraStream, HasBuffersForHalfASecondButNoMoreThanMemoryBears) {
  const FakeCameraProcess process;
  if (!process.is_running()) GTEST_SKIP() << "no camera on loopback";
  const OpenedCamera opened = open_camera(process.address(), "genicam:x");
  const auto buffers = [&](std::size_t bytes, std::optional<std::chrono::nanoseconds> period) {
    return free_buffers(open_stream(opened.camera.get(), bytes, period, "genicam:x").get());
  };
  EXPECT_EQ(buffers(1000, 1ms), 400);
  EXPECT_EQ(buffers(1000, 10ms), 50);
  EXPECT_EQ(buffers(1000, 100ms), 8);
  EXPECT_EQ(buffers(1000, {}), 50);
  EXPECT_EQ(buffers(16 << 20, 1ms), 32);
  EXPECT_EQ(buffers(100 << 20, 1ms), 8);
}

TEST(CameraStream, CountsNothingBeforeItRuns) {
  const FakeCameraProcess process;
  if (!process.is_running()) GTEST_SKIP() << "no camera on loopback";
  const OpenedCamera opened = open_camera(process.address(), "genicam:x");
  const auto stream = open_stream(opened.camera.get(), 1000, 1ms, "genicam:x");
  for (const auto& [name, count] : stream_statistics(stream.get())) EXPECT_EQ(count, 0u) << name;
}

}  // namespace
}  // namespace alidade
