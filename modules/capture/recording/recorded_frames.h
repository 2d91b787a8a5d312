// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

#include "capture/recording/frame_row.h"
#include "capture/recording/session_file.h"
#include "io/lossless_decoder.h"
#include "io/matroska_writer.h"

namespace alidade {

/// The rows of frames.csv, one by one. Not a last line that was not written to its end.
class FrameRows {
 public:
  /// Throws InputError where there is no such file, or its header is another.
  explicit FrameRows(const std::filesystem::path& folder);

  /// Empty at the end. Throws InputError for a row that cannot be.
  std::optional<FrameRow> next();

  const std::filesystem::path& path() const { return path_; }
  int line() const { return line_; }               ///< of the row given last
  std::int64_t end() const { return end_; }        ///< of that row in the file, bytes
  bool has_half_row() const { return half_row_; }  ///< once next() gave empty

 private:
  std::optional<std::string> next_line();

  std::filesystem::path path_;
  std::ifstream file_;
  int line_ = 0;
  std::int64_t end_ = 0;
  bool half_row_ = false;
};

/// The video of a recording, whose frames are found by their rows.
class RecordedVideo {
 public:
  /// Throws InputError where there is no such file, or it does not begin as a recording's.
  RecordedVideo(const std::filesystem::path& folder, const RecordingSession& session);

  const std::filesystem::path& path() const { return path_; }
  const MatroskaHeader& header() const { return header_; }
  std::int64_t size() const { return size_; }  ///< of the file, bytes

  /// The packet whose cluster begins at `position`, whole; empty where there is none.
  std::optional<MatroskaPacket> packet_at(std::int64_t position);

  /// The image of a packet; empty where it cannot be read.
  std::optional<cv::Mat> read(std::int64_t position, std::int64_t size);

 private:
  std::string bytes(std::int64_t position, std::int64_t size);

  std::filesystem::path path_;
  std::ifstream file_;
  std::int64_t size_ = 0;
  MatroskaHeader header_;
  std::optional<LosslessDecoder> decoder_;
};

}  // namespace alidade
