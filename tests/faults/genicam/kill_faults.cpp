// SPDX-License-Identifier: Apache-2.0
#include <random>
#include <thread>

#include <fmt/format.h>

#include "tests/faults/genicam/aravis_alone.h"
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

struct Trial {
  std::vector<double> event_ms, return_ms;  // of the cycles survived
  ProcessResources before, after;
};

Trial kill_again_and_again(const FaultBench& bench) {
  std::mt19937 random(1);
  auto camera = bench.start_camera(bench.address);
  LiveCapture capture(bench.address, small_request(kFps));
  capture.wait_for_frame({}, milliseconds(5000));
  Trial trial;
  trial.before = process_resources();
  for (int cycle = 0; cycle < bench.cycles; ++cycle) {
    const Outcome outcome = kill_once(bench, capture, camera, random);
    if (!outcome.is_recovered) break;
    trial.event_ms.push_back(outcome.event_ms);
    trial.return_ms.push_back(outcome.return_ms);
    if (cycle == 0) trial.before.resident_mb = process_resources().resident_mb;  // the first brings in what stays
  }
  trial.after = settled_resources(trial.before, milliseconds(15000));
  return trial;
}

}  // namespace

Figures kill_figures(const FaultBench& bench) {
  const Trial trial = kill_again_and_again(bench);
  const auto& [event_ms, return_ms, before, after] = trial;
  const double survived = static_cast<double>(return_ms.size());
  const double gained_mb = after.resident_mb - before.resident_mb;
  const auto median = [](const std::vector<double>& ms) { return fmt::format("median {:.0f}", quantile(ms, 0.5)); };
  Figures figures{
      {"kill", "cycles survived", survived, "", bench.cycles, {}, fmt::format("of {}", bench.cycles)},
      {"kill",
       "slowest event after the last frame",
       quantile(event_ms, 1),
       "ms",
       {},
       5 * kPeriodMs + 100,
       median(event_ms)},
      {"kill", "slowest return after the camera is back", quantile(return_ms, 1), "ms", {}, 2000, median(return_ms)},
      {"kill", "descriptors gained", static_cast<double>(after.descriptors - before.descriptors), "", {}, 0},
      {"kill", "threads gained", static_cast<double>(after.threads - before.threads), "", {}, 0},
      {"kill", "memory gained since the first cycle", gained_mb, "MB", {}, 8}};
  if (bench.is_compared) {
    figures.push_back({"kill", "event of Aravis alone after the last frame", aravis_notice_ms(bench), "ms", {}, {}});
  }
  return figures;
}

}  // namespace alidade::test
