// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/genicam/fault_bench.h"

namespace alidade::test {

std::unique_ptr<CameraProcess> FaultBench::start_camera(const std::string& where,
                                                        std::vector<std::string> arguments) const {
  arguments.insert(arguments.end(), {"--address", where, "--serial", "AT-" + where, "--log", log_of(where).string()});
  return std::make_unique<CameraProcess>(camera_program, arguments);
}

CameraRequest small_request(double fps_hz) {
  CameraRequest request;
  request.size = cv::Size(320, 240);
  request.pixel_format = "Mono8";
  request.fps_hz = fps_hz;
  request.exposure_s = 0.002;
  request.packet_size = 1500;
  return request;
}

}  // namespace alidade::test
