// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "core/progress.h"
#include "datasets/rendered_sky.h"

namespace alidade {

/// Writes what the cameras of a scene film into a directory that exists: a lossless video for each receiver, called
/// NAME.mkv after it, whose stream's time is the receiver's own clock; and where each target truly is in each frame,
/// truth_pixels.csv. Ends early, with whole files, where a stop is requested. Returns the videos' names, in the order
/// of the receivers. Throws DeviceError where the file system refuses, and as SkyVideo does.
std::vector<std::string> write_sky_videos(const SkyScene& scene, const std::filesystem::path& directory,
                                          const ProgressSink& progress = {}, std::stop_token stop = {});

}  // namespace alidade
