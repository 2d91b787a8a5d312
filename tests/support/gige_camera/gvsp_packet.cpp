// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/gvsp_packet.h"

namespace alidade::test {
namespace {

constexpr std::uint16_t kUnavailable = 0x800c;
constexpr std::uint16_t kImagePayload = 0x0001;

GvspHeader header_of(std::uint16_t status, std::uint16_t frame_id, GvspContent content, std::uint32_t packet_id) {
  GvspHeader header{};
  const std::span bytes(header);
  write_big_endian(bytes, status);
  write_big_endian(bytes.subspan(2), frame_id);
  write_big_endian(bytes.subspan(4), static_cast<std::uint32_t>(content) << 24U | packet_id);
  return header;
}

}  // namespace

GvspHeader gvsp_header(std::uint16_t frame_id, GvspContent content, std::uint32_t packet_id) {
  return header_of(0, frame_id, content, packet_id);
}

GvspHeader gvsp_unavailable_header(std::uint16_t frame_id, std::uint32_t packet_id) {
  return header_of(kUnavailable, frame_id, GvspContent::Payload, packet_id);
}

Bytes gvsp_leader(const GvspImage& image) {
  Bytes leader;
  append_big_endian(leader, std::uint16_t{0});
  append_big_endian(leader, kImagePayload);
  append_big_endian(leader, image.timestamp);
  append_big_endian(leader, image.pixel_format);
  for (const int value : {image.region.width, image.region.height, image.region.x, image.region.y}) {
    append_big_endian(leader, static_cast<std::uint32_t>(value));
  }
  append_big_endian(leader, std::uint32_t{0});  // no padding
  return leader;
}

Bytes gvsp_trailer(int height) {
  Bytes trailer;
  append_big_endian(trailer, std::uint32_t{kImagePayload});
  append_big_endian(trailer, static_cast<std::uint32_t>(height));
  return trailer;
}

}  // namespace alidade::test
