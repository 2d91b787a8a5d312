// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "capture/frame_source.h"
#include "capture/genicam/aravis_objects.h"
#include "capture/genicam/block_ids.h"
#include "capture/genicam/camera_setup.h"

using ArvBuffer = struct _ArvBuffer;

namespace alidade {

/// The frame that a buffer of `allocated` bytes came back with. A damaged one bears what came of it; where what came is
/// no image of the size granted, its image is empty.
Frame frame_of_buffer(ArvBuffer* buffer, std::size_t allocated, const CameraSetup& setup, BlockIds& ids);

/// The steady clock's reading when the clock of the day showed `realtime_ns`, which was just now; now if that was no
/// moment of the last second (the clock of the day was set meanwhile).
HostTime host_time_of_realtime(std::int64_t realtime_ns);

}  // namespace alidade
