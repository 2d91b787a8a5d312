// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <opencv2/core/types.hpp>

#include "tests/support/gige_camera/big_endian.h"

namespace alidade::test {

/// Bytes in front of the data of every packet of a frame; and with the headers of IP and UDP, which GigE Vision counts
/// as part of the packet size.
constexpr std::size_t kGvspHeaderSize = 8;
constexpr std::size_t kGvspOverhead = 20 + 8 + kGvspHeaderSize;

using GvspHeader = std::array<std::uint8_t, kGvspHeaderSize>;

/// A frame is sent as a leader (packet 0), its payload in packets of equal size but the last, and a trailer.
enum class GvspContent : std::uint8_t { Leader = 1, Trailer = 2, Payload = 3 };

GvspHeader gvsp_header(std::uint16_t frame_id, GvspContent content, std::uint32_t packet_id);

/// The header of a packet that is no longer there to be sent again; it comes without data.
GvspHeader gvsp_unavailable_header(std::uint16_t frame_id, std::uint32_t packet_id);

/// What the leader tells of the image behind it.
struct GvspImage {
  std::uint32_t pixel_format = 0;  ///< PFNC's number
  cv::Rect region;                 ///< px, on the sensor
  std::uint64_t timestamp = 0;     ///< ticks of the camera's clock
};

/// The data of leader and trailer.
Bytes gvsp_leader(const GvspImage& image);
Bytes gvsp_trailer(int height);

}  // namespace alidade::test
