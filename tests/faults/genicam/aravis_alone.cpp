// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/genicam/aravis_alone.h"

#include <atomic>
#include <chrono>
#include <memory>

#include <arv.h>

#include "capture/genicam/heartbeat.h"

namespace alidade::test {
namespace {

template <typename T>
struct Unref {
  void operator()(T* object) const { g_object_unref(object); }
};

void note_loss(ArvDevice*, void* is_lost) {
  *static_cast<std::atomic<bool>*>(is_lost) = true;
}

// Takes frames until `is_enough` says so; `last` is the moment of the last.
template <typename Enough>
HostTime take_frames(ArvStream* stream, HostTime last, Enough is_enough) {
  for (int frames = 0; !is_enough(frames);) {
    ArvBuffer* const buffer = arv_stream_timeout_pop_buffer(stream, 10'000);
    if (!buffer) continue;
    last = HostClock::now();
    ++frames;
    arv_stream_push_buffer(stream, buffer);
  }
  return last;
}

}  // namespace

double aravis_notice_ms(const FaultBench& bench) {
  const auto process = bench.start_camera(bench.address);
  std::atomic<bool> is_lost = false;  // set by Aravis' thread
  const std::unique_ptr<ArvCamera, Unref<ArvCamera>> camera(arv_camera_new(bench.address.c_str(), nullptr));
  if (!camera) return 0;
  g_signal_connect(arv_camera_get_device(camera.get()), "control-lost", G_CALLBACK(note_loss), &is_lost);
  double notice_ms = 0;
  {
    const std::unique_ptr<ArvStream, Unref<ArvStream>> stream(
        arv_camera_create_stream(camera.get(), nullptr, nullptr, nullptr));
    for (int i = 0; i < 10; ++i) {
      arv_stream_push_buffer(stream.get(), arv_buffer_new(arv_camera_get_payload(camera.get(), nullptr), nullptr));
    }
    arv_camera_start_acquisition(camera.get(), nullptr);
    const HostTime end = HostClock::now() + std::chrono::seconds(20);
    const HostTime before =
        take_frames(stream.get(), {}, [&](int frames) { return frames >= 15 || HostClock::now() > end; });
    process->kill();
    const HostTime last = take_frames(stream.get(), before, [&](int) { return is_lost || HostClock::now() > end; });
    if (is_lost) notice_ms = std::chrono::duration<double, std::milli>(HostClock::now() - last).count();
  }
  await_heartbeat(camera.get(), &is_lost);
  return notice_ms;
}

}  // namespace alidade::test
