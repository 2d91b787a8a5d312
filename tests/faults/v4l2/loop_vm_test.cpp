// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/faults/v4l2/looped_frames.h"
#include "tests/faults/v4l2/vivid.h"

namespace alidade::test {
namespace {

/// Noise, another one each frame.
std::vector<std::uint8_t> noise(std::size_t bytes) {
  std::vector<std::uint8_t> result(bytes);
  std::uint32_t state = 1;
  for (std::uint8_t& byte : result) {
    state = state * 1664525 + 1013904223;
    byte = static_cast<std::uint8_t>(state >> 24);
  }
  return result;
}

class V4l2LoopInTheMachine : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!has_vivid()) GTEST_SKIP() << "no vivid here";
  }
};

TEST_P(V4l2LoopInTheMachine, GivesBackTheFramesThatWereShown) {
  constexpr int kFrames = 30;
  RawFrames frames{{}, {320, 240}, GetParam(), true};
  const std::vector<std::uint8_t> bytes = noise(frames.frame_bytes() * kFrames);
  frames.bytes = bytes;
  LoopedFrames looped(frames, {});
  std::uint64_t dropped = 0;
  std::optional<std::uint64_t> first, last;
  while (const auto frame = looped.next()) {
    dropped += frame->stamp.dropped_before;
    last = frame->stamp.sequence;
    if (!first) first = last;
  }
  const std::vector<int>& shown = looped.shown();
  ASSERT_GE(shown.size(), kFrames / 2U);
  EXPECT_EQ(shown.front(), 0);
  EXPECT_EQ(shown.back(), kFrames - 1);
  EXPECT_TRUE(std::is_sorted(shown.begin(), shown.end()));
  EXPECT_EQ(std::count(shown.begin(), shown.end(), -1), 0);
  EXPECT_EQ(dropped, *last - *first + 1 - shown.size());
}

INSTANTIATE_TEST_SUITE_P(Formats, V4l2LoopInTheMachine, testing::Values("GREY", "YUYV"));

}  // namespace
}  // namespace alidade::test
