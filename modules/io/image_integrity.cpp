// SPDX-License-Identifier: Apache-2.0
#include "io/image_integrity.h"

#include <cstdint>

namespace alidade {
namespace {

constexpr unsigned char kStartOfScan = 0xDA, kEndOfImage = 0xD9;

bool stands_alone(unsigned char marker) {
  return marker == 0x01 || (marker >= 0xD0 && marker <= 0xD7);
}

// Walks from marker to marker, so that the end of a thumbnail inside a segment is not taken for the image's.
bool jpeg_has_its_end(std::string_view bytes) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  std::size_t at = 2;
  bool in_scan = false;
  while (at + 1 < bytes.size()) {
    if (byte(at) != 0xFF || byte(at + 1) == 0xFF || (in_scan && byte(at + 1) == 0) || stands_alone(byte(at + 1))) {
      at += byte(at) == 0xFF && byte(at + 1) != 0xFF ? 2 : 1;  // fill bytes, or coded data of a scan
      continue;
    }
    const unsigned char marker = byte(at + 1);
    if (marker == kEndOfImage) return true;
    if (at + 3 >= bytes.size()) return false;
    in_scan = marker == kStartOfScan;
    at += 2 + (std::size_t{byte(at + 2)} << 8 | byte(at + 3));
  }
  return false;
}

// Each chunk: length, type, that many bytes, checksum. Whether the bytes are right is libpng's to say.
bool png_has_its_end(std::string_view bytes) {
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    std::uint64_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(bytes[at + i]);
    if (bytes.substr(at + 4, 4) == "IEND") return true;
    at += 12 + length;
  }
  return false;
}

}  // namespace

std::optional<std::string> find_image_damage(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xD8") && !jpeg_has_its_end(bytes)) return "is a JPEG that is cut off";
  if (bytes.starts_with("\x89PNG\r\n\x1A\n") && !png_has_its_end(bytes)) return "is a PNG that is cut off";
  return std::nullopt;
}

}  // namespace alidade
