// SPDX-License-Identifier: Apache-2.0
#include "io/ebml.h"

#include <bit>
#include <stdexcept>

namespace alidade {
namespace {

int byte_count(std::uint64_t value) {
  int count = 1;
  while (count < 8 && value >> (8 * count) != 0) ++count;
  return count;
}

std::string bytes_of_id(std::uint32_t id) {
  return big_endian(id, byte_count(id));
}

// The first byte's leading zeros say how many bytes follow. Zero where there is no such number.
std::size_t coded_length(char first) {
  return static_cast<std::size_t>(std::countl_zero(static_cast<unsigned char>(first))) + 1;
}

}  // namespace

std::string big_endian(std::uint64_t value, int count) {
  std::string bytes;
  for (int i = count - 1; i >= 0; --i) bytes.push_back(static_cast<char>(value >> (8 * i)));
  return bytes;
}

std::uint64_t parse_big_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char c : bytes) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

std::string ebml_long_size(std::uint64_t size) {
  return big_endian(std::uint64_t{1} << 56 | size, 8);
}

std::string ebml_element(std::uint32_t id, std::string_view payload) {
  std::string bytes = bytes_of_id(id);
  const std::uint64_t size = payload.size();
  bytes += size < 127 ? big_endian(0x80 | size, 1) : ebml_long_size(size);
  return bytes.append(payload);
}

std::string ebml_unsigned(std::uint32_t id, std::uint64_t value) {
  return ebml_element(id, big_endian(value, byte_count(value)));
}

std::string ebml_float(std::uint32_t id, double value) {
  return ebml_element(id, big_endian(std::bit_cast<std::uint64_t>(value), 8));
}

std::string ebml_void(std::size_t size) {
  constexpr std::uint32_t kVoid = 0xEC;
  if (size < 2 || size > 128) throw std::invalid_argument("ebml_void: size must be 2 to 128 bytes");
  return ebml_element(kVoid, std::string(size - 2, '\0'));
}

std::optional<EbmlHead> parse_ebml_head(std::string_view bytes) {
  if (bytes.empty()) return std::nullopt;
  const std::size_t id_length = coded_length(bytes[0]);
  if (id_length > 4 || bytes.size() <= id_length) return std::nullopt;
  const std::size_t size_length = coded_length(bytes[id_length]);
  if (size_length > 8 || bytes.size() < id_length + size_length) return std::nullopt;
  const std::uint64_t mask = (std::uint64_t{1} << (7 * size_length)) - 1;
  const std::uint64_t size = parse_big_endian(bytes.substr(id_length, size_length)) & mask;
  return EbmlHead{static_cast<std::uint32_t>(parse_big_endian(bytes.substr(0, id_length))),
                  size == mask ? kUnknownSize : size, id_length + size_length};
}

}  // namespace alidade
