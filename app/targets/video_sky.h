// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "app/targets/sky_source.h"
#include "camera/receiver.h"

namespace alidade {

/// Told of every reading that is found in an image.
using ReadingSink = std::function<void(const ReceiverReading&)>;

/// Whether a source is looked at, not read: a video, images, a recording or a live camera, and no table of
/// observations.
bool shows_images(const std::string& source);

/// The videos in a folder, as `simulate targets --videos` leaves it: NAME.mkv or NAME.mp4 of each receiver. Empty where
/// there is a table of observations, or a video is missing.
std::vector<std::string> videos_in(const std::string& folder, std::span<const Receiver> receivers);

/// Small moving objects in the images of several cameras, one source (as open_frames takes it) for each receiver, in
/// order; the cameras take turns by the common clock. Throws InputError where a source cannot be opened, has no times
/// or other images than its receiver's camera, a receiver is no camera, and for another number of sources.
std::unique_ptr<SkySource> open_videos(const std::vector<std::string>& sources, std::span<const Receiver> receivers,
                                       ReadingSink found, std::stop_token stop);

}  // namespace alidade
