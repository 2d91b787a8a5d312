// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/software_trigger.h"

#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace alidade {
namespace {

using namespace std::chrono_literals;

TEST(NextMultiple, IsTheFirstAfterNow) {
  EXPECT_EQ(next_multiple(HostTime(25ms), 10ms), HostTime(30ms));
  EXPECT_EQ(next_multiple(HostTime(30ms), 10ms), HostTime(40ms));
  EXPECT_EQ(next_multiple(HostTime(0ms), 7ns), HostTime(7ns));
}

TEST(SoftwareTrigger, FiresSoonAfterTheMultiplesOfThePeriod) {
  std::mutex mutex;
  std::vector<HostTime> times;
  const HostTime start = HostClock::now();
  {
    const SoftwareTrigger trigger(20ms, [&] {
      const std::scoped_lock lock(mutex);
      times.push_back(HostClock::now());
    });
    std::this_thread::sleep_for(210ms);
  }
  // A busy machine may be late now and then, never early.
  EXPECT_GE(times.size(), 5u);
  EXPECT_LE(times.size(), static_cast<std::size_t>((HostClock::now() - start) / 20ms) + 1);
  std::size_t punctual = 0;
  for (const HostTime time : times) punctual += time.time_since_epoch() % 20ms < 5ms ? 1 : 0;
  EXPECT_GE(punctual, times.size() / 2);
}

TEST(SoftwareTrigger, LeavesOutMultiplesThatPassMeanwhile) {
  std::atomic<int> count = 0;
  {
    const SoftwareTrigger trigger(5ms, [&] {
      ++count;
      std::this_thread::sleep_for(50ms);
    });
    std::this_thread::sleep_for(180ms);
  }
  EXPECT_GE(count, 1);
  EXPECT_LE(count, 5);
}

TEST(SoftwareTrigger, RefusesAPeriodOfNothing) {
  EXPECT_THROW(SoftwareTrigger(0ns, [] {}), std::invalid_argument);
}

}  // namespace
}  // namespace alidade
