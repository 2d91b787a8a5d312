// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace alidade {

/// The CRC-32 (of IEEE 802.3, as zlib, gzip and PNG have it) of bytes that come piece by piece.
class Crc32 {
 public:
  Crc32() = default;
  explicit Crc32(std::string_view bytes) { add(bytes); }

  void add(std::string_view bytes);

  /// As if the bytes of `rest` had been added.
  void add(const Crc32& rest);

  std::uint32_t value() const { return value_; }
  std::int64_t length() const { return length_; }  ///< bytes

 private:
  std::uint32_t value_ = 0;
  std::int64_t length_ = 0;
};

/// Of a whole file. Throws InputError where it cannot be read.
Crc32 crc32_of_file(const std::filesystem::path& path);

}  // namespace alidade
