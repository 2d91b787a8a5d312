// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/camera_log.h"

#include <cstdio>

#include <fmt/format.h>

#include "core/errors.h"

namespace alidade::test {
namespace {

constexpr const char* kHeader = "acquisition,frame,frame_id,picture,t_device_ns,t_host_ns,exposure_ns,is_dropped";

std::optional<LoggedFrame> parse(const std::string& line) {
  LoggedFrame frame;
  unsigned id = 0;
  long long host_ns = 0;
  long long exposure_ns = 0;
  int is_dropped = 0;
  unsigned long long number = 0;
  unsigned long long device_ns = 0;
  const int read = std::sscanf(line.c_str(), "%d,%llu,%u,%u,%llu,%lld,%lld,%d", &frame.acquisition, &number, &id,
                               &frame.picture, &device_ns, &host_ns, &exposure_ns, &is_dropped);
  if (read != 8) return std::nullopt;
  frame.frame = number;
  frame.id = static_cast<std::uint16_t>(id);
  frame.device_time = device_ns;
  frame.host_time = HostTime(std::chrono::nanoseconds(host_ns));
  frame.exposure = std::chrono::nanoseconds(exposure_ns);
  frame.is_dropped = is_dropped != 0;
  return frame;
}

}  // namespace

CameraLog::CameraLog(const std::filesystem::path& path) : file_(path) {
  file_ << kHeader << std::endl;
  if (!file_) throw DeviceError(path.string(), "write", "the log cannot be written", "give another --log");
}

void CameraLog::add(const LoggedFrame& frame) {
  const auto host_ns = std::chrono::nanoseconds(frame.host_time.time_since_epoch()).count();
  file_ << fmt::format("{},{},{},{},{},{},{},{}\n", frame.acquisition, frame.frame, frame.id, frame.picture,
                       frame.device_time, host_ns, frame.exposure.count(), frame.is_dropped ? 1 : 0)
        << std::flush;
}

std::vector<LoggedFrame> read_camera_log(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line) || line != kHeader) {
    throw InputError(path.string(), 1, "is no log of a test camera", "give what --log wrote");
  }
  std::vector<LoggedFrame> frames;
  while (std::getline(file, line)) {
    if (file.eof()) break;  // no line end: cut off
    if (const std::optional<LoggedFrame> frame = parse(line)) frames.push_back(*frame);
  }
  return frames;
}

}  // namespace alidade::test
