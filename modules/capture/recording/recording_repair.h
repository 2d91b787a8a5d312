// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "capture/recording/frame_row.h"
#include "core/progress.h"

namespace alidade {

/// What a repair did.
struct RecordingRepair {
  bool was_closed = false;     ///< there was nothing to do, and nothing was done
  RecordingTotals totals;      ///< of the recording, as it is now
  int recovered = 0;           ///< frames that were in the video and had no row; now they have one, flagged
  int lost = 0;                ///< rows given up since their frames are not in the video (a power cut)
  std::int64_t cut_bytes = 0;  ///< of frames and rows that were not written to their end
};

/// Brings an interrupted recording into the state of a closed one: cuts off what was written in part, gives the files
/// their names, and session.json its totals and checksums. Frames that are whole in the video but have no row get one,
/// flagged "recovered": their pixels and time are known, their stamps are not. No frame that can be read is given up.
/// Nothing is done to a closed recording; a repair that was itself interrupted is done again.
/// Throws InputError where it is no recording or a file of it is missing, DeviceError where it cannot be written.
RecordingRepair repair_recording(const std::filesystem::path& folder, const ProgressSink& progress = {});

}  // namespace alidade
