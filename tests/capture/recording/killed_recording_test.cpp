// SPDX-License-Identifier: Apache-2.0
#include "tests/capture/recording/killed_recording.h"

#include <random>

#include <gtest/gtest.h>

#include "capture/recording/recording.h"
#include "capture/recording/recording_repair.h"
#include "capture/recording/recording_verification.h"
#include "tests/capture/recording/synthetic_camera.h"
#include "tests/support/temporary_directory.h"

namespace alidade {
namespace {

TEST(KilledRecording, LosesNoConfirmedFrameAndIsReadableAsItIs) {
  const test::TemporaryDirectory folder;
  std::mt19937 random(6);
  const std::vector<PixelFormat> formats = test::all_pixel_formats();
  for (std::size_t i = 0; i < 5; ++i) {
    const RecordingSubject camera = test::synthetic_camera(formats[i], {160, 120});
    const auto delay = std::chrono::microseconds(std::uniform_int_distribution(20'000, 120'000)(random));
    const auto path = folder / std::to_string(i);
    const test::KilledRecording killed = test::record_and_kill(path, camera, {}, delay);
    SCOPED_TRACE(fmt::format("{} after {} us, {} captured", name_of(formats[i]), delay.count(), killed.captured));
    EXPECT_EQ(killed.read_by_us, killed.confirmed);
    EXPECT_EQ(killed.wrong, 0);
    EXPECT_LE(killed.captured - killed.confirmed, 3);
    EXPECT_GE(killed.by_ffprobe.value_or(killed.confirmed), killed.confirmed);
    if (!is_recording(path)) {  // killed before it had begun
      EXPECT_EQ(killed.confirmed, 0);
      continue;
    }
    const RecordingRepair repair = repair_recording(path);
    EXPECT_EQ(repair.lost, 0);
    EXPECT_EQ(repair.totals.frames, killed.confirmed + repair.recovered);
    const RecordingVerification verification = verify_recording(path);
    for (const RecordingFault& fault : verification.faults) ADD_FAILURE() << fault.path << ": " << fault.what;
  }
}

}  // namespace
}  // namespace alidade
