// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace alidade {

/// Elements of EBML, which Matroska consists of: an id, a size, and a payload, which may be elements again.
/// Source: RFC 8794. The ids are those of RFC 9559 (Matroska), marker bits included.
std::string ebml_element(std::uint32_t id, std::string_view payload);
std::string ebml_unsigned(std::uint32_t id, std::uint64_t value);
std::string ebml_float(std::uint32_t id, double value);

/// An element that means nothing, `size` bytes long in all, 2 to 128: room for one that is known only later.
std::string ebml_void(std::size_t size);

/// `count` bytes (1 to 8) of `value`, most significant first.
std::string big_endian(std::uint64_t value, int count);

/// The value of up to 8 bytes, most significant first.
std::uint64_t parse_big_endian(std::string_view bytes);

/// The size of a payload in eight bytes, and the one that says "not known".
std::string ebml_long_size(std::uint64_t size);
inline constexpr std::uint64_t kUnknownSize = 0x00FF'FFFF'FFFF'FFFF;

/// The head of an element.
struct EbmlHead {
  std::uint32_t id = 0;
  std::uint64_t size = 0;  ///< of the payload, bytes; kUnknownSize where it is not said
  std::size_t length = 0;  ///< of the head itself, bytes, at most 12
};

/// The head that `bytes` begin with; empty where they are too few or none.
std::optional<EbmlHead> parse_ebml_head(std::string_view bytes);

}  // namespace alidade
