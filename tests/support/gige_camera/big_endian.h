// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace alidade::test {

/// The bytes of packets and registers.
using Bytes = std::vector<std::uint8_t>;

/// The number that the first sizeof(T) bytes spell, the highest byte first. `bytes` must hold as many.
template <std::unsigned_integral T>
T read_big_endian(std::span<const std::uint8_t> bytes) {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>((value << 8U) | bytes[i]);
  return value;
}

/// Spells `value` into the first sizeof(T) bytes.
template <std::unsigned_integral T>
void write_big_endian(std::span<std::uint8_t> bytes, T value) {
  for (std::size_t i = sizeof(T); i-- > 0; value = static_cast<T>(value >> 8U))
    bytes[i] = static_cast<std::uint8_t>(value);
}

/// Spells `value` behind the last byte.
template <std::unsigned_integral T>
void append_big_endian(Bytes& bytes, T value) {
  bytes.resize(bytes.size() + sizeof(T));
  write_big_endian(std::span(bytes).last(sizeof(T)), value);
}

}  // namespace alidade::test
