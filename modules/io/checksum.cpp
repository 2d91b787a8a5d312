// SPDX-License-Identifier: Apache-2.0
#include "io/checksum.h"

#include <array>
#include <fstream>

#include <zlib.h>

#include "core/errors.h"

namespace alidade {

void Crc32::add(std::string_view bytes) {
  value_ =
      static_cast<std::uint32_t>(::crc32_z(value_, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
  length_ += static_cast<std::int64_t>(bytes.size());
}

void Crc32::add(const Crc32& rest) {
  value_ = static_cast<std::uint32_t>(::crc32_combine(value_, rest.value_, rest.length_));
  length_ += rest.length_;
}

Crc32 crc32_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path, 0, "cannot be read", "check its name and permissions");
  Crc32 crc;
  std::array<char, 1 << 16> buffer;
  while (file.read(buffer.data(), buffer.size()) || file.gcount() > 0) {
    crc.add({buffer.data(), static_cast<std::size_t>(file.gcount())});
  }
  if (file.bad()) throw InputError(path, 0, "cannot be read to its end", "check the disk");
  return crc;
}

}  // namespace alidade
