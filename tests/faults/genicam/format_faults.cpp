// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <fmt/format.h>

#include "tests/faults/genicam/fault_bench.h"
#include "tests/faults/genicam/live_capture.h"
#include "tests/faults/genicam/tally.h"
#include "tests/support/gige_camera/payload_format.h"

namespace alidade::test {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kFrames = 5;

// Whether the first frames are bit by bit as exposed.
bool is_exact(const FaultBench& bench, const CameraRequest& request) {
  LiveCapture capture(bench.address, request);
  if (!capture.wait_for_count(kFrames, milliseconds(3000))) return false;
  capture.stop();
  const Tally tally = tally_of(capture.frames(), read_camera_log(bench.log_of(bench.address)));
  return tally.good >= static_cast<int>(kFrames) && tally.wrong == 0 && tally.unexplained() == 0;
}

CameraRequest request_of(std::string_view format, cv::Rect region, double fps_hz) {
  CameraRequest request = small_request(fps_hz);
  request.pixel_format = std::string(format);
  request.offset = region.tl();
  request.size = region.size();
  request.exposure_s = 0.0005;
  return request;
}

}  // namespace

Figures format_figures(const FaultBench& bench) {
  const auto camera = bench.start_camera(bench.address);
  int exact = 0;
  std::string inexact;
  for (const PayloadFormat& format : payload_formats()) {
    const bool is_right = is_exact(bench, request_of(format.name, {16, 8, 101, 37}, 100));
    exact += is_right ? 1 : 0;
    if (!is_right) inexact += fmt::format("{} ", format.name);
  }
  const bool is_line_exact = is_exact(bench, request_of("Mono12Packed", {0, 700, 2048, 1}, 1000));
  const bool is_block_exact = is_exact(bench, request_of("Mono8", {0, 0, 2047, 16}, 500));
  return {{"format",
           "pixel formats exact to the bit",
           static_cast<double>(exact),
           "",
           static_cast<double>(payload_formats().size()),
           {},
           inexact},
          {"format", "lines exact, 1000 per second", is_line_exact ? 1.0 : 0.0, "", 1, {}},
          {"format", "blocks of 16 lines exact, 500 per second", is_block_exact ? 1.0 : 0.0, "", 1, {}}};
}

}  // namespace alidade::test
