// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <opencv2/core/types.hpp>

namespace alidade {

/// The one track of a video.
struct MatroskaTrack {
  std::string codec_id;                            ///< Matroska's name of the codec: "V_FFV1"
  std::string codec_private;                       ///< what a decoder must know beforehand; empty for many
  std::uint32_t fourcc = 0;                        ///< of V_UNCOMPRESSED: its pixel format
  cv::Size size;                                   ///< px
  std::optional<std::chrono::nanoseconds> period;  ///< between two frames, where it is known
};

/// What stands before the first frame of a video, and where in it what is known only at its end: until then there is
/// room (Void elements), so that the file is whole at any moment.
struct MatroskaHeader {
  std::string bytes;
  std::size_t segment_begin = 0;  ///< positions in Matroska count from here
  std::size_t index_note = 0;     ///< where the place of the index is told (SeekHead)
  std::size_t duration = 0;
  std::string codec_private;
};

MatroskaHeader make_matroska_header(const MatroskaTrack& track);

/// The header that a file begins with, which make_matroska_header made; empty where it is none.
std::optional<MatroskaHeader> parse_matroska_header(std::string_view bytes);

/// Writes into the header how long the video is, where in the file its index stands, if it has one, and how long the
/// file is.
void close_matroska_header(MatroskaHeader& header, std::chrono::nanoseconds duration,
                           std::optional<std::int64_t> index_position, std::int64_t file_size);

}  // namespace alidade
