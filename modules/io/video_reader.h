// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

#include "core/time.h"

namespace alidade {

/// What a video's header says.
struct VideoFacts {
  int width = 0, height = 0;       ///< px
  std::string codec;               ///< "h264", "ffv1", ...
  std::optional<double> fps_hz;    ///< mean frame rate, where known
  std::optional<int> frame_count;  ///< where the container counts them
};

/// A decoded frame: 8 bits, BGR, or grey where the video is.
struct VideoFrame {
  std::optional<Timestamp> time;  ///< of the stream; empty where it has none
  cv::Mat image;
};

/// Reads a video from its start to its end, through libav. The pixels are those stored: a note that the player should
/// turn the picture is ignored, as the camera's intrinsics know nothing of it. The same file gives the same frames.
class VideoReader {
 public:
  /// Throws InputError where the file is missing or no video that can be decoded.
  explicit VideoReader(const std::filesystem::path& path);
  ~VideoReader();
  VideoReader(VideoReader&&) noexcept;
  VideoReader& operator=(VideoReader&&) noexcept;

  const VideoFacts& facts() const;

  /// The next frame that can be read whole; those that cannot are left out and told by fault(). Empty at the end.
  /// Throws InputError where the size changes on the way.
  std::optional<VideoFrame> next();

  /// Once next() has given empty: what is missing or damaged ("clip.mp4: ends after 1.200 s of 3.333 s, 36 frames can
  /// be read; the file is cut off or damaged"). Empty where all frames were read.
  std::optional<std::string> fault() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alidade
