// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace alidade {

/// An sRGB colour: red, green, blue.
using Rgb = std::array<std::uint8_t, 3>;

/// The colours that every picture of ours uses for the same thing.
namespace palette {
inline constexpr Rgb kTruth{214, 96, 28};        ///< what was measured by something better than us
inline constexpr Rgb kEstimate{18, 98, 184};     ///< what we computed
inline constexpr Rgb kReference{120, 120, 128};  ///< what somebody else computed
inline constexpr Rgb kInk{38, 40, 46};           ///< text and axes
inline constexpr Rgb kPaper{255, 255, 255};
}  // namespace palette

/// The colour of the i-th curve of a plot; repeats after eight. Distinguishable with red-green blindness
/// (Okabe and Ito's palette, yellow darkened for white paper).
inline Rgb curve_colour(std::size_t i) {
  constexpr std::array<Rgb, 8> kCurves{{{18, 98, 184},
                                        {214, 96, 28},
                                        {0, 146, 110},
                                        {190, 100, 160},
                                        {200, 150, 0},
                                        {80, 170, 220},
                                        {90, 90, 96},
                                        {120, 60, 20}}};
  return kCurves[i % kCurves.size()];
}

}  // namespace alidade
