// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/v4l2/vivid.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "capture/v4l2/v4l2_camera.h"
#include "capture/v4l2/v4l2_controls.h"

namespace alidade::test {

bool has_vivid() {
  try {
    return V4l2Device(kWebcam).identity().driver == "vivid";
  } catch (const CameraError&) {
    return false;
  }
}

int parameter(const char* name, int fallback) {
  const char* text = std::getenv(name);
  return text ? std::stoi(text) : fallback;
}

void set_control(const std::string& path, std::string_view name, std::string_view value) {
  set_v4l2_control(V4l2Device(path), name, value);
}

CameraRequest small_request(double fps_hz) {
  CameraRequest request;
  request.size = cv::Size(320, 180);
  request.fps_hz = fps_hz;
  return request;
}

cv::Mat image_in_format(const std::string& path, const std::string& format) {
  CameraRequest request = small_request(60);
  request.pixel_format = format;
  const auto camera = open_v4l2(path, request);
  for (int i = 0; i < 2; ++i) {
    const auto frame = camera->wait(std::chrono::seconds(2));
    if (!frame) throw std::runtime_error("no frame from " + path + " in format " + format);
    if (i == 1) return frame->image;
  }
  return {};
}

int open_descriptors() {
  return static_cast<int>(std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {}));
}

int resident_kb() {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;) {
    int value = 0;
    if (word == "VmRSS:" && file >> value) return value;
  }
  throw std::runtime_error("/proc/self/status tells no VmRSS");
}

WebcamReset::~WebcamReset() {
  for (const auto& [name, value] : {std::pair{"percentage_of_dropped_buffers", "0"},
                                    {"wrap_sequence_number", "off"},
                                    {"timestamp_source", "End of Frame"}}) {
    set_control(kWebcam, name, value);
  }
}

}  // namespace alidade::test
