// SPDX-License-Identifier: Apache-2.0
#include <thread>

#include <fmt/format.h>

#include "tests/faults/genicam/fault_bench.h"
#include "tests/faults/genicam/live_capture.h"

namespace alidade::test {
namespace {

using std::chrono::milliseconds;

constexpr double kFps = 30;
constexpr double kPeriodMs = 1000 / kFps;
constexpr double kNever = 1e9;

double ms_between(HostTime from, HostTime to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

// How long after the last frame a stall was told of.
double told_after_ms(LiveCapture& capture, HostTime since) {
  const auto event =
      capture.wait_for_event({CaptureEventKind::Stalled, CaptureEventKind::Disconnected}, since, milliseconds(10000));
  double told_ms = kNever;
  if (!event) return told_ms;
  for (const SeenFrame& frame : capture.frames()) {
    if (frame.arrival < event->time) told_ms = ms_between(frame.arrival, event->time);
  }
  return told_ms;
}

double frame_after_ms(LiveCapture& capture, HostTime since) {
  const auto frame = capture.wait_for_frame(since, milliseconds(15000));
  return frame ? ms_between(since, frame->arrival) : kNever;
}

}  // namespace

Figures freeze_figures(const FaultBench& bench) {
  Figures figures;
  for (const int frozen_s : {1, 6}) {
    const auto camera = bench.start_camera(bench.address);
    LiveCapture capture(bench.address, small_request(kFps));
    capture.wait_for_count(15, milliseconds(5000));
    const HostTime frozen = HostClock::now();
    camera->freeze();
    const double told_ms = told_after_ms(capture, frozen);
    std::this_thread::sleep_until(frozen + std::chrono::seconds(frozen_s));
    camera->thaw();
    const double back_ms = frame_after_ms(capture, HostClock::now());
    const std::string when = fmt::format(", frozen for {} s", frozen_s);
    figures.push_back({"freeze", "event after the last frame" + when, told_ms, "ms", {}, 5 * kPeriodMs + 100});
    figures.push_back({"freeze", "good frame after the end" + when, back_ms, "ms", {}, 2000});
  }
  return figures;
}

Figures stall_figures(const FaultBench& bench) {
  const auto camera = bench.start_camera(bench.address);
  LiveCapture capture(bench.address, small_request(kFps));
  capture.wait_for_count(15, milliseconds(5000));
  std::vector<double> told_ms;
  std::vector<double> back_ms;
  for (int cycle = 0; cycle < bench.cycles; ++cycle) {
    const HostTime stalled = HostClock::now();
    constexpr milliseconds kStall(600);
    camera->command("stall 0.6");
    told_ms.push_back(told_after_ms(capture, stalled));
    std::this_thread::sleep_until(stalled + kStall);
    back_ms.push_back(frame_after_ms(capture, stalled + kStall));
    std::this_thread::sleep_for(milliseconds(300));
  }
  return {{"stall", "slowest event after the last frame", quantile(told_ms, 1), "ms", {}, 250},
          {"stall", "slowest frame after the end", quantile(back_ms, 1), "ms", {}, 2000}};
}

Figures busy_figures(const FaultBench& bench) {
  const auto camera = bench.start_camera(bench.address);
  LiveCapture first(bench.address, small_request(kFps));
  first.wait_for_count(5, milliseconds(5000));
  bool is_busy = false;
  std::string line;
  const HostTime asked = HostClock::now();
  try {
    const LiveCapture second(bench.address, small_request(kFps));
  } catch (const CameraError& error) {
    is_busy = error.trouble() == CameraTrouble::Busy;
    line = error.what();
  }
  const bool is_one_line = !line.empty() && line.find('\n') == std::string::npos;
  const double refused_ms = ms_between(asked, HostClock::now());
  const double next_ms = frame_after_ms(first, HostClock::now());
  return {{"busy", "a second client is told so in one line", is_busy && is_one_line ? 1.0 : 0.0, "", 1, {}, line},
          {"busy", "time until it is told", refused_ms, "ms", {}, 2000},
          {"busy", "next frame of the first client", next_ms, "ms", {}, 5 * kPeriodMs}};
}

}  // namespace alidade::test
