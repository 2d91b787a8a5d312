// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace alidade {

/// How a text is set: in DejaVu Sans, or in VTK's built-in font (ASCII only) where that is not installed.
struct TextFont {
  double size_px = 14;  ///< height of the em square
  bool bold = false;
};

/// A line of UTF-8 text as coverage (CV_8UC1, 0..255), cropped to its line: the same height for every text of a font,
/// at least 1×1. Needs no display. Safe to call from several threads (they take turns).
cv::Mat text_mask(const std::string& text, const TextFont& font);

}  // namespace alidade
