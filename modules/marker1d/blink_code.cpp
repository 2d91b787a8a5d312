// SPDX-License-Identifier: Apache-2.0
#include "marker1d/blink_code.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

using Bits = std::uint32_t;

Bits rotated(Bits code, int length, int shift) {
  const Bits all = (Bits{1} << length) - 1;
  return ((code << shift) | (code >> (length - shift))) & all;
}

int least_distance(Bits a, Bits b, int length, int first_shift) {
  int least = length;
  for (int shift = first_shift; shift < length; ++shift) {
    least = std::min(least, std::popcount(a ^ rotated(b, length, shift)));
  }
  return least;
}

// Of all shifts of a code one stands for them: the largest.
bool is_largest_shift(Bits code, int length) {
  for (int shift = 1; shift < length; ++shift) {
    if (rotated(code, length, shift) > code) return false;
  }
  return true;
}

int longest_dark_run(Bits code, int length) {
  int longest = 0, run = 0;
  for (int row = 0; row < 2 * length; ++row) {
    run = (code >> (row % length)) & 1 ? 0 : run + 1;
    longest = std::max(longest, run);
  }
  return longest;
}

std::string text_of(Bits code, int length) {
  std::string text;
  for (int row = length - 1; row >= 0; --row) text += (code >> row) & 1 ? '1' : '0';
  return text;
}

// As many codes of this length as are found one after the other, the most lit first.
std::vector<Bits> codes_of_length(int length, int count, const BlinkCodeOptions& options) {
  std::vector<Bits> candidates;
  for (Bits code = 1; code < Bits{1} << length; ++code) {
    const bool holds = is_largest_shift(code, length) && longest_dark_run(code, length) <= options.longest_dark &&
                       least_distance(code, code, length, 1) >= options.distance;
    if (holds) candidates.push_back(code);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](Bits a, Bits b) { return std::popcount(a) > std::popcount(b); });
  std::vector<Bits> chosen;
  for (const Bits code : candidates) {
    if (static_cast<int>(chosen.size()) == count) break;
    const bool is_apart = std::all_of(chosen.begin(), chosen.end(), [&](Bits other) {
      return least_distance(code, other, length, 0) >= options.distance;
    });
    if (is_apart) chosen.push_back(code);
  }
  return chosen;
}

int distance_from_shift(std::string_view a, std::string_view b, std::size_t first_shift) {
  int least = static_cast<int>(a.size());
  for (std::size_t shift = first_shift; shift < b.size(); ++shift) {
    int differing = 0;
    for (std::size_t row = 0; row < a.size(); ++row) differing += a[row] != b[(row + shift) % b.size()];
    least = std::min(least, differing);
  }
  return least;
}

std::string repeated(const std::string& code, std::size_t length) {
  std::string text;
  while (text.size() < length) text += code;
  return text;
}

// Both from row 0 where both phases are known, else at the shift at which they differ least.
bool differ_in_code(const MarkerSign& a, const MarkerSign& b) {
  const std::size_t length = std::lcm(a.code.size(), b.code.size());
  std::string first = repeated(a.code, length), second = repeated(b.code, length);
  if (!a.phase || !b.phase) return cyclic_distance(first, second) > 0;
  std::rotate(first.begin(), first.begin() + *a.phase, first.end());
  std::rotate(second.begin(), second.begin() + *b.phase, second.end());
  return first != second;
}

// Colours are the same within a twentieth of their direction: that is what a camera keeps constant.
bool differ_in_colour(const MarkerSign& a, const MarkerSign& b) {
  if (!a.colour || !b.colour) return false;
  const Eigen::Map<const Eigen::Vector3d> first(a.colour->data()), second(b.colour->data());
  return (first.normalized() - second.normalized()).norm() > 0.05;
}

std::optional<std::string> find_fault(const MarkerSign& sign) {
  constexpr std::size_t kLongest = 1024;
  if (sign.code.empty() || sign.code.size() > kLongest || sign.code.find_first_not_of("01") != std::string::npos) {
    return fmt::format("marker {}: the code must consist of 1 to {} signs 0 and 1, got '{}'", sign.id, kLongest,
                       sign.code.substr(0, 40));
  }
  if (sign.code.find('1') == std::string::npos) return fmt::format("marker {}: the code is never lit", sign.id);
  if (sign.phase && (*sign.phase < 0 || *sign.phase >= static_cast<int>(sign.code.size()))) {
    return fmt::format("marker {}: the phase must be 0 to {}, got {}", sign.id, sign.code.size() - 1, *sign.phase);
  }
  if (!sign.colour) return std::nullopt;
  const auto& colour = *sign.colour;
  const bool is_light = std::all_of(colour.begin(), colour.end(), [](double c) { return std::isfinite(c) && c >= 0; });
  if (is_light && colour[0] + colour[1] + colour[2] > 0) return std::nullopt;
  return fmt::format("marker {}: the colour must be three shares >= 0, not all 0, got {}, {}, {}", sign.id, colour[0],
                     colour[1], colour[2]);
}

}  // namespace

int cyclic_distance(std::string_view a, std::string_view b) {
  if (a.empty() || a.size() != b.size()) {
    throw std::invalid_argument(fmt::format("codes must have one length, got {} and {} rows", a.size(), b.size()));
  }
  return distance_from_shift(a, b, 0);
}

int cyclic_distance(std::string_view code) {
  if (code.empty()) throw std::invalid_argument("a code must have a row, got none");
  return distance_from_shift(code, code, 1);
}

std::vector<std::string> blink_codes(int count, const BlinkCodeOptions& options) {
  constexpr int kLongest = 20;
  if (count < 1 || options.distance < 1 || options.longest_dark < 1) {
    throw std::invalid_argument(fmt::format("count, distance and longest_dark must be >= 1, got {}, {}, {}", count,
                                            options.distance, options.longest_dark));
  }
  for (int length = 3; length <= kLongest; ++length) {
    const auto codes = codes_of_length(length, count, options);
    if (static_cast<int>(codes.size()) < count) continue;
    std::vector<std::string> texts;
    for (const Bits code : codes) texts.push_back(text_of(code, length));
    return texts;
  }
  throw std::invalid_argument(
      fmt::format("{} codes of distance {} do not fit into {} rows", count, options.distance, kLongest));
}

std::optional<std::string> find_fault(std::span<const MarkerSign> signs) {
  if (signs.empty()) return "there is no marker";
  for (const MarkerSign& sign : signs) {
    if (const auto fault = find_fault(sign)) return fault;
  }
  for (std::size_t i = 0; i < signs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const MarkerSign &a = signs[k], &b = signs[i];
      if (a.id == b.id) return fmt::format("marker {} is listed twice", a.id);
      if (differ_in_code(a, b) || differ_in_colour(a, b)) continue;
      return fmt::format("markers {} and {} cannot be told apart: codes '{}' and '{}'", a.id, b.id, a.code, b.code);
    }
  }
  return std::nullopt;
}

}  // namespace alidade
