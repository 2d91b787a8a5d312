// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

namespace alidade {

/// The CRC-32 of the pixels of an image, row by row, without what may lie between the rows.
std::uint32_t pixels_crc32(const cv::Mat& image);

}  // namespace alidade
