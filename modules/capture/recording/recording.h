// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "capture/frame_source.h"

namespace alidade {

/// Whether the folder is one camera's recording, closed or not.
bool is_recording(const std::filesystem::path& folder);

/// The frames of a recording, as fast as they can be read: images in the camera's own PixelFormat (see decoded()), with
/// their times and stamps, exactly as they were recorded, damaged frames too. Of one that is not closed (interrupted,
/// or still going on): all that were confirmed when it was opened; nothing is changed. Frame::name is "FOLDER#index".
/// A frame whose pixels are not those recorded (the disk has damaged them) is flagged as damaged, its image empty where
/// nothing could be read. fault() tells of these, of lost frames, and of a recording that was not closed;
/// frames that the camera damaged say so themselves.
/// Throws InputError where it is no recording; next() where the video is missing or a row cannot be.
std::unique_ptr<FrameSource> open_recording(const std::filesystem::path& folder);

}  // namespace alidade
