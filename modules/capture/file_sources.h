// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "capture/frame_source.h"

namespace alidade {

/// An image file and its moment.
struct TimedImage {
  std::filesystem::path path;
  Timestamp time{};
};

/// The images in the order given; `timed` says whether the times mean anything (FrameSource::has_times), `description`
/// goes to the report. Read ahead in a thread. Throws InputError where `images` is empty.
std::unique_ptr<FrameSource> open_images(std::vector<TimedImage> images, bool timed, const std::string& description);

/// The frames of a video with the times of its stream, or `fps_hz` frames per second where the stream has none.
/// Read ahead in a thread. Throws InputError where it is no video.
std::unique_ptr<FrameSource> open_video(const std::filesystem::path& path, std::optional<double> fps_hz = std::nullopt);

/// Opens what the user names: a video; the folder of a recording (decoded, at its own times); a folder or glob
/// ("shots/*.jpg") of images, in natural order of their names (2 before 10); one image; or a list, a text file with a
/// name per line, or a time in s and a name (TUM's rgb.txt). Times of images come from times.csv or frames.csv beside
/// them (columns t_ns and image, which then say the order too), from the list, or from names that are times; else from
/// `fps_hz`; else each frame is given 1 s and has_times() is false. Throws InputError where there is nothing of that
/// name or no image in it.
std::unique_ptr<FrameSource> open_files(const std::string& source, std::optional<double> fps_hz = std::nullopt);

/// Whether open_files takes a file of this name for a video.
bool is_video_name(const std::filesystem::path& path);

}  // namespace alidade
