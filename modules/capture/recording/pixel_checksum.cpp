// SPDX-License-Identifier: Apache-2.0
#include "capture/recording/pixel_checksum.h"

#include "io/checksum.h"

namespace alidade {

std::uint32_t pixels_crc32(const cv::Mat& image) {
  const std::size_t row = static_cast<std::size_t>(image.cols) * image.elemSize();
  Crc32 crc;
  for (int y = 0; y < image.rows; ++y) crc.add({reinterpret_cast<const char*>(image.ptr(y)), row});
  return crc.value();
}

}  // namespace alidade
