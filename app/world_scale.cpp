// SPDX-License-Identifier: Apache-2.0
#include "app/world_scale.h"

#include <charconv>
#include <vector>

#include <fmt/format.h>

#include "core/errors.h"

namespace alidade {
namespace {

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> words(1);
  for (char c : text) {
    if (c == ':') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

template <typename Number>
std::optional<Number> parse(const std::string& word) {
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

[[noreturn]] void refuse(const std::string& text) {
  throw InputError("--scale", 0,
                   fmt::format("'{}' is neither marker:SIDE_M[:ID] nor distance:FRAME_A:FRAME_B:METRES", text),
                   "lengths are in metres and greater than 0, frames count from 0");
}

}  // namespace

ScaleWish parse_scale(const std::string& text) {
  if (text.empty()) return {};
  const std::vector<std::string> words = split(text);
  if (words[0] == "marker" && (words.size() == 2 || words.size() == 3)) {
    const auto side = parse<double>(words[1]);
    const auto id = words.size() == 3 ? parse<int>(words[2]) : std::optional<int>{};
    if (side && *side > 0 && (words.size() == 2 || id)) return MarkerScale{*side, id};
  }
  if (words[0] == "distance" && words.size() == 4) {
    const auto a = parse<int>(words[1]);
    const auto b = parse<int>(words[2]);
    const auto metres = parse<double>(words[3]);
    if (a && b && metres && *a >= 0 && *b >= 0 && *a != *b && *metres > 0) return KnownDistance{*a, *b, *metres};
  }
  refuse(text);
}

std::optional<FoundScale> find_scale(const ScaleWish& wish, const Camera& camera,
                                     const std::vector<FrameReport>& reports,
                                     const std::vector<FrameMarkers>& markers) {
  if (const auto* known = std::get_if<KnownDistance>(&wish)) {
    const auto similarity = similarity_from_distance(reports, *known);
    if (!similarity) return std::nullopt;
    return FoundScale{*similarity,
                      fmt::format("from the distance between frames {} and {}", known->frame_a, known->frame_b)};
  }
  if (const auto* marker = std::get_if<MarkerScale>(&wish)) {
    const auto similarity = similarity_from_marker(camera, reports, markers, marker->side_m, marker->id);
    if (!similarity) return std::nullopt;
    return FoundScale{*similarity, fmt::format("from a marker of {} m, which is the origin", marker->side_m)};
  }
  return std::nullopt;
}

}  // namespace alidade
