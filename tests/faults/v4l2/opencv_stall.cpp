// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>

#include <opencv2/videoio.hpp>

#include "tests/faults/v4l2/vivid.h"

// For comparison: how long OpenCV's capture blocks when the webcam of the virtual machine stalls, as JSON.
int main() {
  using alidade::test::kWebcam;
  cv::VideoCapture capture(kWebcam, cv::CAP_V4L2);
  capture.set(cv::CAP_PROP_FRAME_WIDTH, 320);
  capture.set(cv::CAP_PROP_FRAME_HEIGHT, 180);
  capture.set(cv::CAP_PROP_FPS, 30);
  cv::Mat image;
  for (int i = 0; i < 10; ++i) {
    if (!capture.read(image)) return 1;
  }
  alidade::test::set_control(kWebcam, "percentage_of_dropped_buffers", "100");
  bool came = true;
  double blocked_s = 0;
  for (int i = 0; came && i < 10; ++i) {  // frames that were ready come first
    const auto begin = std::chrono::steady_clock::now();
    came = capture.read(image);
    blocked_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  alidade::test::set_control(kWebcam, "percentage_of_dropped_buffers", "0");
  std::printf("{\"opencv_stall_blocked_s\": %.3f}\n", blocked_s);
  return came ? 1 : 0;
}
