// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include <opencv2/core/mat.hpp>

namespace alidade {

/// How a video is written.
enum class VideoKind {
  Movie,     ///< MP4: H.264 where libx264 is there, else MPEG-4; small, plays everywhere, not exact
  Lossless,  ///< MKV: FFV1, every pixel as it was; readable to the last frame even when never closed
};

/// Options of a video to write.
struct VideoOptions {
  VideoKind kind = VideoKind::Movie;
  double fps_hz = 30.0;  ///< frame i is shown at i / fps_hz
  /// Of a movie: x264's constant rate factor, 0 (exact) to 51 (coarse). 20 is visually close to the original.
  int rate_factor = 20;
};

/// Writes a video, checking every write; it is called NAME.part until close() returns.
/// Every call throws DeviceError where the file system refuses (full disk, no permission).
/// A movie that is never closed is removed (MP4 keeps its index at the end); a lossless NAME.part stays.
class VideoWriter {
 public:
  /// `size`: px; a movie with an odd width or height is padded by a row or column that repeats the last.
  /// Throws std::invalid_argument for a size or frame rate that is not positive.
  VideoWriter(const std::filesystem::path& path, cv::Size size, const VideoOptions& options = {});
  ~VideoWriter();
  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;

  /// Appends a frame of 8 bits, grey or BGR (all alike in a lossless video), of the size given.
  void write(const cv::Mat& image);

  /// Writes what is left and gives the file its name. At most once, and last.
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alidade
