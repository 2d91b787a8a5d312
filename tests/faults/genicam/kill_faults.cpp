// SPDX-License-Identifier: Apache-2.0
#include <random>
#include <thread>

#include <fmt/format.h>

#include "tests/faults/genicam/fault_bench.h"
#include "tests/faults/genicam/live_capture.h"
#include "tests/faults/genicam/process_resources.h"

namespace alidade::test {
namespace {

using std::chrono::milliseconds;

constexpr double kFps = 30;
constexpr double kPeriodMs = 1000 / kFps;

double ms_between(HostTime from, HostTime to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

struct Outcome {
  bool is_recovered = false;
  double event_ms = 0;   // after the last frame
  double return_ms = 0;  // after the camera is back
};

// Kills the camera at a random moment of its period, leaves it dead for a random while, starts it again.
Outcome kill_once(const FaultBench& bench, LiveCapture& capture, std::unique_ptr<CameraProcess>& camera,
                  std::mt19937& random) {
  const auto any_ms = [&](int least, int most) {
    return milliseconds(std::uniform_int_distribution(least, most)(random));
  };
  std::this_thread::sleep_for(any_ms(200, 400));
  const HostTime killed = HostClock::now();
  camera->kill();
  const auto event =
      capture.wait_for_event({CaptureEventKind::Stalled, CaptureEventKind::Disconnected}, killed, milliseconds(10000));
  if (!event) return {};
  const HostTime last_frame = capture.frames().back().arrival;
  std::this_thread::sleep_for(any_ms(0, 1500));
  camera = bench.start_camera(bench.address);
  const HostTime back = HostClock::now();
  const auto frame = capture.wait_for_frame(back, milliseconds(10000));
  if (!frame) return {};
  return {.is_recovered = true,
          .event_ms = ms_between(last_frame, event->time),
          .return_ms = ms_between(back, frame->arrival)};
}

}  // namespace

Figures kill_figures(const FaultBench& bench) {
  std::mt19937 random(1);
  auto camera = bench.start_camera(bench.address);
  LiveCapture capture(bench.address, small_request(kFps));
  capture.wait_for_frame({}, milliseconds(5000));
  std::vector<double> event_ms;
  std::vector<double> return_ms;
  ProcessResources before = process_resources();
  for (int cycle = 0; cycle < bench.cycles; ++cycle) {
    const Outcome outcome = kill_once(bench, capture, camera, random);
    if (!outcome.is_recovered) break;
    event_ms.push_back(outcome.event_ms);
    return_ms.push_back(outcome.return_ms);
    if (cycle == 0) before.resident_mb = process_resources().resident_mb;  // the first brings in what stays
  }
  const ProcessResources after = settled_resources(before, milliseconds(15000));
  const auto figure = [](std::string name, double value, std::string unit, std::optional<double> least,
                         std::optional<double> most, std::string detail = "") {
    return Figure{"kill", std::move(name), value, std::move(unit), least, most, std::move(detail)};
  };
  const double cycles = bench.cycles;
  return {figure("cycles survived", static_cast<double>(return_ms.size()), "", cycles, {},
                 fmt::format("of {}", bench.cycles)),
          figure("slowest event after the last frame", quantile(event_ms, 1), "ms", {}, 5 * kPeriodMs + 100,
                 fmt::format("median {:.0f}", quantile(event_ms, 0.5))),
          figure("slowest return after the camera is back", quantile(return_ms, 1), "ms", {}, 2000,
                 fmt::format("median {:.0f}", quantile(return_ms, 0.5))),
          figure("descriptors gained", after.descriptors - before.descriptors, "", {}, 0),
          figure("threads gained", after.threads - before.threads, "", {}, 0),
          figure("memory gained since the first cycle", after.resident_mb - before.resident_mb, "MB", {}, 8)};
}

}  // namespace alidade::test
