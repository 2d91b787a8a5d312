// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "capture/file_sources.h"
#include "core/errors.h"

// Writes the frames of a video or of images as v4l2_loop takes them: grey, one behind the other. Runs on the host.
namespace {

void write_raw(const std::string& source, const std::string& path) {
  const auto frames = alidade::open_files(source, 30.0);
  std::ofstream out(path, std::ios::binary);
  cv::Size size;
  int count = 0;
  for (; const auto frame = frames->next(); ++count) {
    cv::Mat grey = frame->image;
    if (grey.channels() == 3) cv::cvtColor(frame->image, grey, cv::COLOR_BGR2GRAY);
    for (int y = 0; y < grey.rows; ++y) out.write(grey.ptr<char>(y), grey.cols);
    size = grey.size();
  }
  out.flush();
  if (!out) throw alidade::DeviceError(path, "write", "the file could not be written", "is there room?");
  fmt::print("{{\"width\": {}, \"height\": {}, \"frames\": {}}}\n", size.width, size.height, count);
}

}  // namespace

int main(int count, char** words) {
  if (count != 3) {
    fmt::print(stderr, "usage: raw_frames SOURCE FILE\n");
    return 2;
  }
  try {
    write_raw(words[1], words[2]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
