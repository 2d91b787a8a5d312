// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include "tests/faults/genicam/fault_bench.h"
#include "tests/faults/genicam/live_capture.h"
#include "tests/faults/genicam/tally.h"

namespace alidade::test {
namespace {

using std::chrono::milliseconds;

constexpr double kFps = 30;
constexpr double kSettled_s = 1;  // clocks are compared from here on

// What Frame::time says of the middle of each exposure, less the truth, ms.
std::vector<double> time_errors_ms(const std::vector<SeenFrame>& frames, const std::vector<LoggedFrame>& log) {
  std::vector<double> errors_ms;
  for (const SeenFrame& frame : frames) {
    const LoggedFrame* const exposed = find_stamped(log, frame.stamp);
    if (!exposed || frame.arrival - frames.front().arrival < std::chrono::duration<double>(kSettled_s)) continue;
    const auto truth = exposed->host_time.time_since_epoch() + exposed->exposure / 2;
    errors_ms.push_back(std::chrono::duration<double, std::milli>(frame.time.time_since_epoch() - truth).count());
  }
  return errors_ms;
}

Figure error_figure(const std::string& camera, const std::vector<double>& errors_ms) {
  double worst_ms = errors_ms.empty() ? 1e9 : 0;
  for (const double error : errors_ms) worst_ms = std::max(worst_ms, std::abs(error));
  return {"clock",
          "largest error of the time of exposure, " + camera,
          worst_ms,
          "ms",
          {},
          1,
          fmt::format("median {:.3f} of {} frames", quantile(errors_ms, 0.5), errors_ms.size())};
}

// Whether the frames of the last while came without any trouble.
Figure untouched_figure(LiveCapture& other, HostTime since, double seconds) {
  int gaps = 0;
  int frames = 0;
  for (const SeenFrame& frame : other.frames()) {
    if (frame.arrival < since) continue;
    ++frames;
    gaps += frame.stamp.dropped_before > 0 || frame.stamp.is_damaged || !frame.is_exact ? 1 : 0;
  }
  for (const CaptureEvent& event : other.events()) gaps += event.time > since ? 1 : 0;
  const double missing = std::max(0.0, std::floor(seconds * kFps) - 2 - frames);
  return {"clock", "troubles of a camera when the other is killed",    gaps + missing, "", {},
          0,       fmt::format("{} frames in {:g} s", frames, seconds)};
}

}  // namespace

Figures clock_figures(const FaultBench& bench) {
  auto first_camera = bench.start_camera(bench.address, {"--clock-offset", "1000", "--clock-rate", "40"});
  auto second_camera = bench.start_camera(bench.other_address, {"--clock-offset", "-5.5", "--clock-rate", "-25"});
  CameraRequest request = small_request(kFps);
  LiveCapture first(bench.address, request);
  request.exposure_s = 0.008;
  LiveCapture second(bench.other_address, request);
  std::this_thread::sleep_for(std::chrono::duration<double>(bench.clocks_s));
  const HostTime killed = HostClock::now();
  first_camera->kill();
  constexpr milliseconds kAfter(1500);
  std::this_thread::sleep_for(kAfter);
  const Figure untouched = untouched_figure(second, killed, std::chrono::duration<double>(kAfter).count());
  second.stop();
  return {
      error_figure("40 ppm fast", time_errors_ms(first.frames(), read_camera_log(bench.log_of(bench.address)))),
      error_figure("25 ppm slow", time_errors_ms(second.frames(), read_camera_log(bench.log_of(bench.other_address)))),
      untouched};
}

}  // namespace alidade::test
