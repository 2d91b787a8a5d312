// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "capture/frame_source.h"

namespace alidade {

/// A row of frames.csv: one frame of a recording, and the confirmation that it is in the video.
struct FrameRow {
  std::int64_t index = 0;         ///< counts the rows from 0
  std::int64_t source_index = 0;  ///< Frame::index as it came; events.csv counts by it
  Timestamp time{};
  CaptureStamp stamp{};
  bool is_recovered = false;  ///< found in the video by repair, its row lost: only index, time and pixels are known
  /// Where its packet lies in the video, bytes; empty where the frame came without an image.
  std::optional<std::int64_t> position;
  std::int64_t size = 0;           ///< of the packet, bytes
  std::uint32_t pixels_crc32 = 0;  ///< of the pixels, row by row, as the camera gave them (not of the packet)

  std::int64_t packet_end() const { return position.value_or(0) + size; }
};

/// The first line of frames.csv, with its end.
std::string frame_row_header();

/// A line with its end; parse_frame_row gives the same row back.
std::string format_frame_row(const FrameRow& row);

/// Throws InputError naming path, line and column.
FrameRow parse_frame_row(std::string_view text, const std::filesystem::path& path, int line);

/// What a recording holds and lost, added up over its rows.
struct RecordingTotals {
  std::int64_t frames = 0;         ///< rows
  std::int64_t without_image = 0;  ///< of these, rows whose frame came without an image
  std::int64_t damaged = 0;        ///< of these, said to be by the driver
  std::int64_t recovered = 0;      ///< of these, found by repair
  std::uint64_t dropped = 0;       ///< counted by the camera, never came
  std::uint64_t discarded = 0;     ///< given up by our queue

  void add(const FrameRow& row);
  friend bool operator==(const RecordingTotals&, const RecordingTotals&) = default;
};

}  // namespace alidade
