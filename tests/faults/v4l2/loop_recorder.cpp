// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <fstream>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include "capture/recording/recording_writer.h"
#include "tests/faults/v4l2/looped_frames.h"

// Shows raw frames at the video output of the virtual machine and records what its camera sees of them.
namespace alidade::test {
namespace {

constexpr const char* kUsage =
    "usage: v4l2_loop FRAMES WIDTH HEIGHT FORMAT DIR [slow]\n"
    "FRAMES: a file of raw frames in the V4L2 format FORMAT (GREY, YUYV). DIR: becomes a recording, and in shown.csv\n"
    "which of the frames each recorded one is. 30 Hz, or 14.4 Hz where slow. Prints figures as JSON.\n";

/// A file in memory, as it is needed.
class MappedFile {
 public:
  explicit MappedFile(const std::string& path) {
    const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat told {};
    if (fstat(file.number(), &told) != 0) throw InputError(path, 0, "cannot be read", "name a file of raw frames");
    const auto size = static_cast<std::size_t>(told.st_size);
    void* memory = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number(), 0);
    if (memory == MAP_FAILED) throw InputError(path, 0, "cannot be mapped", "name a file of raw frames");
    bytes_ = {static_cast<const std::uint8_t*>(memory), size};
  }
  ~MappedFile() { munmap(const_cast<std::uint8_t*>(bytes_.data()), bytes_.size()); }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
  std::span<const std::uint8_t> bytes_;
};

void record(const RawFrames& frames, const std::filesystem::path& folder) {
  std::vector<CaptureEvent> events;
  LoopedFrames looped(frames, [&](const CaptureEvent& event) { events.push_back(event); });
  RecorderOptions options;
  options.codec = LosslessCodec::Raw;  // the emulated processor has no time for packing
  RecordingWriter writer(folder, {"v4l2_loop", looped.camera(), loop_request(frames)}, options);
  std::uint64_t dropped = 0;
  while (const auto frame = looped.next()) {
    writer.write(*frame);
    dropped += frame->stamp.dropped_before;
  }
  for (const CaptureEvent& event : events) writer.note(event);
  writer.close();

  std::ofstream shown(folder / "shown.csv");
  shown << "index,shown\n";
  int missed = 0, last = 0;
  for (std::size_t i = 0; i < looped.shown().size(); ++i) {
    const int frame = looped.shown()[i];
    shown << i << ',' << frame << '\n';
    missed += std::max(0, frame - last - 1);
    last = frame;
  }
  fmt::print("{{\"loop_frames\": {}, \"loop_recorded\": {}, \"loop_dropped\": {}, \"loop_missed\": {}}}\n",
             frames.count(), looped.shown().size(), dropped, missed);
}

}  // namespace
}  // namespace alidade::test

int main(int count, char** words) {
  const bool is_slow = count == 7 && std::string_view(words[6]) == "slow";
  if (count != 6 && !is_slow) {
    fmt::print(stderr, "{}", alidade::test::kUsage);
    return 2;
  }
  try {
    const alidade::test::MappedFile file(words[1]);
    const cv::Size size(std::stoi(words[2]), std::stoi(words[3]));
    alidade::test::record({file.bytes(), size, words[4], is_slow}, words[5]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
