// SPDX-License-Identifier: Apache-2.0
#include "io/image_integrity.h"

#include <array>
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

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xEDB88320u ^ (c >> 1) : c >> 1;
    table[i] = c;
  }
  return table;
}

// PNG's checksum of a chunk. Source: PNG specification, annex D.
std::uint32_t crc32(std::string_view bytes) {
  static constexpr auto kTable = make_crc_table();
  std::uint32_t c = 0xFFFFFFFFu;
  for (const char byte : bytes) c = kTable[(c ^ static_cast<unsigned char>(byte)) & 0xFF] ^ (c >> 8);
  return ~c;
}

// Each chunk: length, type, that many bytes, checksum. libpng finds the damage too, but prints it.
std::optional<std::string> find_png_damage(std::string_view bytes) {
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::size_t length = big_endian(bytes.substr(at, 4));
    if (at + 12 + length > bytes.size()) break;
    const std::string_view type = bytes.substr(at + 4, 4);
    if (crc32(bytes.substr(at + 4, 4 + length)) != big_endian(bytes.substr(at + 8 + length, 4))) {
      return "is a damaged PNG";
    }
    if (type == "IEND") return std::nullopt;
    at += 12 + length;
  }
  return "is a PNG that is cut off";
}

}  // namespace

std::optional<std::string> find_image_damage(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xD8") && !jpeg_has_its_end(bytes)) return "is a JPEG that is cut off";
  if (bytes.starts_with("\x89PNG\r\n\x1A\n")) return find_png_damage(bytes);
  return std::nullopt;
}

}  // namespace alidade
