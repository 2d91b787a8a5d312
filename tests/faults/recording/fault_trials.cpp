// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/recording/fault_trials.h"

#include <algorithm>
#include <random>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "capture/recording/recording.h"
#include "capture/recording/recording_names.h"
#include "capture/recording/recording_repair.h"
#include "capture/recording/recording_verification.h"
#include "io/text_lines.h"
#include "tests/capture/recording/killed_recording.h"
#include "tests/capture/recording/synthetic_camera.h"
#include "tests/faults/recording/small_disk.h"

namespace alidade::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
const cv::Size kSize{320, 240};

// Whether a repair makes a recording of `least` frames or more without a fault.
bool is_repaired(const fs::path& folder, int least) {
  if (!is_recording(folder)) return least == 0;
  return repair_recording(folder).totals.frames >= least && verify_recording(folder).faults.empty();
}

// How many frames are read, and how many of them are wrong.
std::pair<int, int> read_again(const fs::path& folder, const RecordingSubject& camera) {
  const auto source = open_recording(folder);
  int count = 0, wrong = 0;
  for (; const auto frame = source->next(); ++count) wrong += are_same(*frame, synthetic_frame(camera, count)) ? 0 : 1;
  return {count, wrong};
}

struct FullDisk {
  double seconds_to_report = 0;  // from the last frame that was confirmed
  std::string report;
  int claimed = 0;  // frames whose write returned
  int rows = 0, read = 0, wrong = 0;
  std::optional<int> by_ffprobe;
  bool has_half_row = false;
};

FullDisk fill_disk(const fs::path& folder, const RecordingSubject& camera) {
  RecorderOptions options;
  options.codec = LosslessCodec::Raw;
  options.keep_free_bytes = 0;
  RecordingWriter writer(folder, camera, options);
  FullDisk result;
  auto last = HostClock::now();
  try {
    for (;; ++result.claimed) {
      writer.write(synthetic_frame(camera, result.claimed));
      last = HostClock::now();
    }
  } catch (const DiskFull& full) {
    result.report = full.what();
    result.seconds_to_report = std::chrono::duration<double>(HostClock::now() - last).count();
  }
  const std::string rows = read_bytes(find_recorded(folder, kFramesName));
  result.rows = static_cast<int>(std::count(rows.begin(), rows.end(), '\n')) - 1;
  result.has_half_row = !rows.ends_with('\n');
  std::tie(result.read, result.wrong) = read_again(folder, camera);
  result.by_ffprobe = count_by_ffprobe(find_recorded(folder, kVideoName));
  return result;
}

}  // namespace

json kill_trials(const fs::path& folder, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution delay_us(10'000, 1'000'000);
  const std::vector<PixelFormat> formats = all_pixel_formats();
  int confirmed = 0, lost = 0, wrong = 0, most_unconfirmed = 0, probed = 0, lost_by_ffprobe = 0, unrepaired = 0;
  for (int i = 0; i < count; ++i) {
    const RecordingSubject camera = synthetic_camera(formats[static_cast<std::size_t>(i) % formats.size()], kSize);
    const fs::path path = folder / fmt::format("killed_{}", i);
    const KilledRecording killed = record_and_kill(path, camera, {}, std::chrono::microseconds(delay_us(random)));
    confirmed += killed.confirmed;
    lost += killed.confirmed - killed.read_by_us;
    wrong += killed.wrong;
    most_unconfirmed = std::max(most_unconfirmed, killed.captured - killed.confirmed);
    if (killed.by_ffprobe) {
      ++probed;
      lost_by_ffprobe += std::max(0, killed.confirmed - *killed.by_ffprobe);
    }
    unrepaired += is_repaired(path, killed.confirmed) ? 0 : 1;
    fs::remove_all(path);
  }
  return {{"section", "kill"},
          {"kills", count},
          {"confirmed", confirmed},
          {"confirmed_lost", lost},
          {"wrong", wrong},
          {"most_unconfirmed", most_unconfirmed},
          {"probed_by_ffprobe", probed},
          {"confirmed_lost_by_ffprobe", lost_by_ffprobe},
          {"not_repaired", unrepaired}};
}

json full_disk_trials(const fs::path& folder, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution bytes(1'000'000, 6'000'000);
  const RecordingSubject camera = synthetic_camera({PixelKind::Yuyv}, kSize);
  double slowest_s = 0;
  int claimed = 0, lost = 0, wrong = 0, half_rows = 0, lost_by_ffprobe = 0, unrepaired = 0;
  std::string report;
  for (int i = 0; i < count; ++i) {
    const SmallDisk disk(folder / fmt::format("disk_{}", i), bytes(random));
    if (!disk.is_mounted()) return {{"section", "full-disk"}, {"skipped", "mounting a small disk needs root"}};
    const FullDisk full = fill_disk(disk.folder() / "camera", camera);
    slowest_s = std::max(slowest_s, full.seconds_to_report);
    claimed += full.claimed;
    lost += std::max(full.claimed, full.rows) - full.read;
    wrong += full.wrong;
    half_rows += full.has_half_row ? 1 : 0;
    if (full.by_ffprobe) lost_by_ffprobe += std::max(0, full.claimed - *full.by_ffprobe);
    unrepaired += is_repaired(disk.folder() / "camera", full.claimed) ? 0 : 1;
    report = full.report;
  }
  return {{"section", "full-disk"},        {"disks", count},
          {"slowest_report_s", slowest_s}, {"claimed", claimed},
          {"claimed_lost", lost},          {"wrong", wrong},
          {"half_rows", half_rows},        {"claimed_lost_by_ffprobe", lost_by_ffprobe},
          {"not_repaired", unrepaired},    {"report", report}};
}

json exactness_trials(const fs::path& folder) {
  constexpr int kFrames = 10;
  int recordings = 0, missing = 0, wrong = 0, faults = 0;
  for (const PixelFormat& format : all_pixel_formats()) {
    for (const auto codec : {LosslessCodec::Raw, LosslessCodec::FfvHuff, LosslessCodec::Ffv1}) {
      const RecordingSubject camera = synthetic_camera(format, kSize);
      const fs::path path = folder / fmt::format("{}_{}", name_of(format), name_of(codec));
      RecorderOptions options;
      options.codec = codec;
      RecordingWriter writer(path, camera, options);
      for (int i = 0; i < kFrames; ++i) writer.write(synthetic_frame(camera, i));
      writer.close();
      const auto [read, differing] = read_again(path, camera);
      ++recordings;
      missing += kFrames - read;
      wrong += differing;
      faults += static_cast<int>(verify_recording(path).faults.size());
      fs::remove_all(path);
    }
  }
  return {{"section", "exact"}, {"recordings", recordings}, {"frames", recordings * kFrames},
          {"missing", missing}, {"wrong", wrong},           {"faults", faults}};
}

}  // namespace alidade::test
