// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/background_release.h"

#include <chrono>
#include <future>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

namespace alidade {
namespace {

TEST(BackgroundRelease, HoldsUpNobodyAndDropsWhatItHeld) {
  std::promise<void> allowed;
  auto held = std::make_shared<int>(1);
  const std::weak_ptr<int> seen = held;
  release_in_background([wait = allowed.get_future().share(), held = std::move(held)] { wait.wait(); });
  EXPECT_EQ(background_releases(), 1);
  EXPECT_FALSE(seen.expired());
  allowed.set_value();
  while (background_releases() > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(seen.expired());
}

}  // namespace
}  // namespace alidade
