// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include "tests/faults/genicam/fault_bench.h"
#include "tests/faults/genicam/live_capture.h"
#include "tests/faults/genicam/tally.h"

namespace alidade::test {
namespace {

using std::chrono::milliseconds;

constexpr double kFps = 20;

CameraRequest triggered(CameraTrigger trigger) {
  CameraRequest request = small_request(kFps);
  request.trigger = trigger;
  return request;
}

// From each exposure of `log` to the nearest of `other`, ms; those before both ran are left out.
std::vector<double> distances_ms(const std::vector<LoggedFrame>& log, const std::vector<LoggedFrame>& other) {
  std::vector<double> distances;
  for (const LoggedFrame& frame : log) {
    if (other.empty() || frame.host_time < other.front().host_time || frame.host_time > other.back().host_time)
      continue;
    double nearest_ms = 1e9;
    for (const LoggedFrame& candidate : other) {
      const std::chrono::duration<double, std::milli> apart = candidate.host_time - frame.host_time;
      nearest_ms = std::min(nearest_ms, std::abs(apart.count()));
    }
    distances.push_back(nearest_ms);
  }
  return distances;
}

Figures software_figures(const FaultBench& bench) {
  const auto first_camera = bench.start_camera(bench.address);
  const auto second_camera = bench.start_camera(bench.other_address);
  LiveCapture first(bench.address, triggered(CameraTrigger::Software));
  LiveCapture second(bench.other_address, triggered(CameraTrigger::Software));
  const bool is_enough = first.wait_for_count(45, milliseconds(8000)) && second.wait_for_count(40, milliseconds(8000));
  first.stop();
  second.stop();
  const std::vector<double> apart_ms =
      distances_ms(read_camera_log(bench.log_of(bench.address)), read_camera_log(bench.log_of(bench.other_address)));
  return {{"trigger", "two cameras stream by software trigger", is_enough ? 1.0 : 0.0, "", 1, {}},
          {"trigger",
           "median time between their exposures",
           apart_ms.empty() ? 1e9 : quantile(apart_ms, 0.5),
           "ms",
           {},
           5,
           fmt::format("largest {:.3f} of {}", quantile(apart_ms, 1), apart_ms.size())}};
}

Figures hardware_figures(const FaultBench& bench) {
  const auto camera = bench.start_camera(bench.address);
  LiveCapture capture(bench.address, triggered(CameraTrigger::Hardware), {.is_triggered = true});
  constexpr std::size_t kPulses = 12;
  std::this_thread::sleep_for(milliseconds(300));  // longer than any stall: nothing is amiss
  for (std::size_t i = 0; i < kPulses; ++i) {
    camera->command("pulse");
    std::this_thread::sleep_for(milliseconds(20 + 10 * static_cast<int>(i)));
  }
  capture.wait_for_count(kPulses, milliseconds(2000));
  int alarms = 0;
  for (const CaptureEvent& event : capture.events()) {
    alarms += event.kind == CaptureEventKind::Opened || event.kind == CaptureEventKind::Streaming ? 0 : 1;
  }
  return {{"trigger", "frames less pulses at line 0", static_cast<double>(capture.frames().size()) - kPulses, "", 0, 0},
          {"trigger", "alarms while no pulse comes", static_cast<double>(alarms), "", {}, 0}};
}

}  // namespace

Figures trigger_figures(const FaultBench& bench) {
  Figures figures = software_figures(bench);
  for (Figure& figure : hardware_figures(bench)) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace alidade::test
