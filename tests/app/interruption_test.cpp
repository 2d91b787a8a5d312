// SPDX-License-Identifier: Apache-2.0
#include "app/interruption.h"

#include <chrono>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

namespace alidade {
namespace {

bool stops_within(const std::stop_token& token, std::chrono::milliseconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!token.stop_requested() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return token.stop_requested();
}

// Each in a process of its own (a death test), for signals stay blocked afterwards.
void expect_stop_by(int signal) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto interrupt = [signal] {
    const Interruption interruption;
    if (interruption.token().stop_requested()) std::exit(1);
    kill(getpid(), signal);
    std::exit(stops_within(interruption.token(), std::chrono::seconds(20)) ? 0 : 2);
  };
  EXPECT_EXIT(interrupt(), testing::ExitedWithCode(0), "");
}

TEST(Interruption, CtrlCRequestsTheStop) {
  expect_stop_by(SIGINT);
}

TEST(Interruption, SigtermRequestsTheStop) {
  expect_stop_by(SIGTERM);
}

TEST(Interruption, SecondSignalEndsTheProgramWith130) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto interrupt_twice = [] {
    const Interruption interruption;
    kill(getpid(), SIGINT);
    stops_within(interruption.token(), std::chrono::seconds(20));
    kill(getpid(), SIGINT);
    std::this_thread::sleep_for(std::chrono::seconds(20));
    std::exit(0);
  };
  EXPECT_EXIT(interrupt_twice(), testing::ExitedWithCode(130), "");
}

TEST(Interruption, EndsWithoutASignal) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto leave = [] {
    { const Interruption interruption; }
    std::exit(0);
  };
  EXPECT_EXIT(leave(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace alidade
