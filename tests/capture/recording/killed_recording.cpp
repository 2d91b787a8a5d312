// SPDX-License-Identifier: Apache-2.0
#include "tests/capture/recording/killed_recording.h"

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "capture/recording/recording.h"
#include "io/text_lines.h"
#include "tests/capture/recording/synthetic_camera.h"

namespace alidade::test {
namespace {

// A number that a child counts and its parent reads, whatever becomes of the child.
class SharedCount {
 public:
  SharedCount() {
    void* const memory = ::mmap(nullptr, sizeof(Value), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::runtime_error("no shared memory");
    value_ = new (memory) Value(0);
  }
  ~SharedCount() { ::munmap(value_, sizeof(Value)); }
  SharedCount(const SharedCount&) = delete;
  SharedCount& operator=(const SharedCount&) = delete;

  std::atomic<int>& value() { return *value_; }

 private:
  using Value = std::atomic<int>;
  Value* value_;
};

[[noreturn]] void record_forever(const std::filesystem::path& folder, const RecordingSubject& camera,
                                 const RecorderOptions& options, std::atomic<int>& captured) {
  RecordingWriter writer(folder, camera, options);
  for (int i = 0;; ++i) {
    const Frame frame = synthetic_frame(camera, i);
    captured = i + 1;
    writer.write(frame);
  }
}

int count_rows(const std::filesystem::path& folder) {
  const std::filesystem::path rows = folder / "frames.csv.part";
  if (!std::filesystem::exists(rows)) return 0;
  const std::string text = read_bytes(rows);
  return std::max(0, static_cast<int>(std::count(text.begin(), text.end(), '\n')) - 1);
}

void read_again(const std::filesystem::path& folder, const RecordingSubject& camera, KilledRecording& result) {
  if (!is_recording(folder)) return;
  const auto source = open_recording(folder);
  while (const auto frame = source->next()) {
    result.wrong += are_same(*frame, synthetic_frame(camera, result.read_by_us)) ? 0 : 1;
    ++result.read_by_us;
  }
}

}  // namespace

std::optional<int> count_by_ffprobe(const std::filesystem::path& video) {
  if (std::system("command -v ffprobe > /dev/null") != 0) return std::nullopt;
  if (!std::filesystem::exists(video)) return 0;
  const std::string command = fmt::format(
      "ffprobe -v quiet -count_frames -select_streams v:0 -show_entries stream=nb_read_frames -of csv=p=0 '{}'",
      video.string());
  FILE* const pipe = ::popen(command.c_str(), "r");
  if (!pipe) throw std::runtime_error("ffprobe cannot be run");
  int count = 0;
  const bool is_number = std::fscanf(pipe, "%d", &count) == 1;
  ::pclose(pipe);
  return is_number ? count : 0;
}

KilledRecording record_and_kill(const std::filesystem::path& folder, const RecordingSubject& camera,
                                const RecorderOptions& options, std::chrono::microseconds delay) {
  SharedCount captured;
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("no process could be started");
  if (child == 0) {
    try {
      record_forever(folder, camera, options, captured.value());
    } catch (...) {
      ::_exit(1);
    }
  }
  std::this_thread::sleep_for(delay);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (!WIFSIGNALED(status)) throw std::runtime_error("the recording ended before it was killed");
  KilledRecording result;
  result.captured = captured.value();
  result.confirmed = count_rows(folder);
  read_again(folder, camera, result);
  result.by_ffprobe = count_by_ffprobe(folder / "video.mkv.part");
  return result;
}

}  // namespace alidade::test
