// SPDX-License-Identifier: Apache-2.0
#include "view/text.h"

#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace alidade {
namespace {

TEST(TextMask, HasTheSameHeightForEveryTextOfAFont) {
  const TextFont font{16};
  const int height = text_mask("aaa", font).rows;
  EXPECT_GE(height, 12);
  EXPECT_LE(height, 26);
  EXPECT_EQ(text_mask("Apfel_|", font).rows, height);
  EXPECT_EQ(text_mask("...", font).rows, height);
}

TEST(TextMask, GrowsWithTheTextAndItsSize) {
  const TextFont font{16};
  EXPECT_NEAR(text_mask("mmmmmmmm", font).cols, 2 * text_mask("mmmm", font).cols, 4);
  EXPECT_NEAR(text_mask("mmmm", {32}).cols, 2 * text_mask("mmmm", font).cols, 6);
}

TEST(TextMask, ShowsSignsBeyondAscii) {
  for (const char* sign : {"°", "σ", "µ", "±", "χ²"}) {
    EXPECT_GT(cv::countNonZero(text_mask(sign, {24})), 10) << sign;
  }
}

TEST(TextMask, IsOneEmptyPixelForNoText) {
  const cv::Mat mask = text_mask("", {16});
  EXPECT_EQ(mask.size(), cv::Size(1, 1));
  EXPECT_EQ(cv::countNonZero(mask), 0);
}

TEST(TextMask, IsTheSameFromSeveralThreads) {
  const cv::Mat expected = text_mask("0.42 px", {18});
  std::vector<int> differing(4, -1);
  std::vector<std::thread> threads;
  for (auto& count : differing) {
    threads.emplace_back([&count, &expected] {
      count = 0;
      for (int i = 0; i < 20; ++i) count += cv::norm(text_mask("0.42 px", {18}), expected, cv::NORM_INF) > 0;
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(differing, std::vector<int>(4, 0));
}

}  // namespace
}  // namespace alidade
