// SPDX-License-Identifier: Apache-2.0
#include "capture/genicam/heartbeat.h"

#include <atomic>
#include <thread>

#include <arv.h>
#include <gtest/gtest.h>

#include "capture/genicam/aravis_objects.h"

namespace alidade {
namespace {

struct Told {
  std::atomic<bool> is_begun = false;
  std::atomic<bool> is_over = false;
};

void tell_slowly(ArvDevice*, void* data) {
  auto* const told = static_cast<Told*>(data);
  told->is_begun = true;
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  told->is_over = true;
}

GObjectPointer<ArvCamera> open_fake_camera() {
  arv_enable_interface("Fake");
  return GObjectPointer<ArvCamera>(arv_camera_new("Fake_1", nullptr));
}

TEST(Heartbeat, IsAwaitedWhileItTellsOfALoss) {
  const auto camera = open_fake_camera();
  ArvDevice* const device = arv_camera_get_device(camera.get());
  Told told;
  g_signal_connect(device, "control-lost", G_CALLBACK(tell_slowly), &told);
  const std::jthread heartbeat([device] { g_signal_emit_by_name(device, "control-lost"); });
  while (!told.is_begun) std::this_thread::yield();
  await_heartbeat(camera.get(), &told);
  EXPECT_TRUE(told.is_over);
}

TEST(Heartbeat, HasNobodyLeftToTell) {
  const auto camera = open_fake_camera();
  ArvDevice* const device = arv_camera_get_device(camera.get());
  Told told;
  g_signal_connect(device, "control-lost", G_CALLBACK(tell_slowly), &told);
  await_heartbeat(camera.get(), &told);
  g_signal_emit_by_name(device, "control-lost");
  EXPECT_FALSE(told.is_begun);
}

}  // namespace
}  // namespace alidade
