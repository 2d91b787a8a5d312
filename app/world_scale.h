// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "tracking/world_frame.h"

namespace alidade {

/// A square marker of known side, as --scale marker:SIDE_M[:ID].
struct MarkerScale {
  double side_m = 0.0;
  std::optional<int> id;
};

/// What the user said of the unit of length.
using ScaleWish = std::variant<std::monostate, KnownDistance, MarkerScale>;

/// Parses "marker:SIDE_M[:ID]" and "distance:FRAME_A:FRAME_B:METRES"; empty text: no wish.
/// Throws InputError saying what was expected.
ScaleWish parse_scale(const std::string& text);

/// What the wish makes of a track: the similarity into metres and the words for the summary; empty where the data does
/// not hold it (no marker seen twice, a frame without pose).
struct FoundScale {
  Similarity T_metric_map;
  std::string words;
};
std::optional<FoundScale> find_scale(const ScaleWish& wish, const Camera& camera,
                                     const std::vector<FrameReport>& reports, const std::vector<FrameMarkers>& markers);

}  // namespace alidade
