// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/thread_urgency.h"

#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace alidade {
namespace {

int own_nice_level() {
  return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
}

TEST(ThreadUrgency, IsOfOneThreadOnly) {
  const int before = own_nice_level();
  int urgent = before;
  std::thread([&] {
    make_this_thread_urgent();
    urgent = own_nice_level();
  }).join();
  EXPECT_EQ(own_nice_level(), before);
  EXPECT_LE(urgent, before);
}

}  // namespace
}  // namespace alidade
