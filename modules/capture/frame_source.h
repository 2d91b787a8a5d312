// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

#include "core/time.h"

namespace alidade {

/// An image and its moment. The pixels are never written after the frame is handed out.
struct Frame {
  int index = 0;     ///< counts the frames of the source from 0
  Timestamp time{};  ///< in the clock of the recording; see FrameSource::has_times
  std::string name;  ///< file name of the image without its folder; for a video "NAME#index"
  cv::Mat image;     ///< 8 bits, grey or BGR, all of one size
};

/// Where images come from, in order of time: files, a video, later a camera. Not for several threads at once.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The next frame, waiting for it if need be; empty at the end. Throws InputError for an image that is damaged or of
  /// another size than the first, DeviceError for a camera that failed.
  virtual std::optional<Frame> next() = 0;

  /// Frames in all; empty where that is not known beforehand.
  virtual std::optional<int> frame_count() const = 0;

  /// Whether the times were measured (or follow from a known frame rate); if not, they count the frames, 1 s each.
  virtual bool has_times() const = 0;

  /// What it is, for the report: "400 images in seven-scenes".
  virtual std::string describe() const = 0;

  /// Once next() has given its last frame: what cut the source short or was lost on the way ("... is cut off after 37
  /// of 100 frames"); empty where all is well.
  virtual std::optional<std::string> fault() const { return std::nullopt; }
};

}  // namespace alidade
