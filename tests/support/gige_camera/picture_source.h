// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include <opencv2/core/mat.hpp>

#include "capture/pixel_format.h"

namespace alidade::test {

/// What the camera looks at.
class PictureSource {
 public:
  virtual ~PictureSource() = default;

  /// The picture before the camera at its `frame`-th exposure, counted from 0; empty when there are no more.
  virtual std::optional<std::uint32_t> picture_at(std::uint64_t frame) const = 0;

  /// What of picture `number` falls into `region` of the sensor, laid out as `format` says.
  virtual cv::Mat picture(std::uint32_t number, const cv::Rect& region, const PixelFormat& format) = 0;
};

/// test_pattern() without end; the pattern begins at the upper left of the region.
std::unique_ptr<PictureSource> open_pattern();

/// The images of a folder, in natural order of their names, over and over or once; all are read into memory. Values are
/// scaled by powers of two to the bits of the format, colours are sampled by the mosaic. Throws InputError where they
/// are not all of one size.
std::unique_ptr<PictureSource> open_picture_folder(const std::filesystem::path& folder, bool is_endless);

/// Of the images of that folder, px.
cv::Size picture_size(const std::filesystem::path& folder);

}  // namespace alidade::test
