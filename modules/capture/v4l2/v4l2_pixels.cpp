// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_pixels.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace alidade {
namespace {

bool holds(const V4l2Plane& plane, std::size_t row_bytes, int rows) {
  if (plane.stride < row_bytes) return false;
  return plane.bytes.size() >= plane.stride * static_cast<std::size_t>(rows - 1) + row_bytes;
}

void copy_row(const std::uint8_t* from, std::size_t bytes, V4l2Packing packing, std::uint8_t* to) {
  switch (packing) {
    case V4l2Packing::Plain:
      std::memcpy(to, from, bytes);
      return;
    case V4l2Packing::Uyvy:
    case V4l2Packing::BigEndian:
      for (std::size_t i = 0; i + 1 < bytes; i += 2) {
        to[i] = from[i + 1];
        to[i + 1] = from[i];
      }
      return;
    case V4l2Packing::Rgb:
      for (std::size_t i = 0; i + 2 < bytes; i += 3) {
        to[i] = from[i + 2];
        to[i + 1] = from[i + 1];
        to[i + 2] = from[i];
      }
      return;
    case V4l2Packing::Mipi10:
      return;  // unpack_mipi10
  }
}

void unpack_mipi10(const std::uint8_t* from, int width, std::uint16_t* to) {
  for (int x = 0; x < width; ++x) {
    const std::uint8_t* group = from + x / 4 * 5;
    to[x] = static_cast<std::uint16_t>(group[x % 4] << 2 | ((group[4] >> (2 * (x % 4))) & 3));
  }
}

cv::Mat jpeg(const V4l2Plane& plane) {
  if (plane.bytes.empty()) return {};
  cv::Mat image(1, static_cast<int>(plane.bytes.size()), CV_8UC1);
  std::memcpy(image.data, plane.bytes.data(), plane.bytes.size());
  return image;
}

/// Luma and colour of an NV12 image as two planes, where the driver gave both in one.
std::pair<V4l2Plane, V4l2Plane> split_nv12(std::span<const V4l2Plane> planes, int height) {
  if (planes.size() > 1) return {planes[0], planes[1]};
  const std::size_t luma = std::min(planes[0].bytes.size(), planes[0].stride * static_cast<std::size_t>(height));
  return {{planes[0].bytes.first(luma), planes[0].stride}, {planes[0].bytes.subspan(luma), planes[0].stride}};
}

cv::Mat nv12(std::span<const V4l2Plane> planes, cv::Size size) {
  const auto [luma, colour] = split_nv12(planes, size.height);
  const auto row_bytes = static_cast<std::size_t>(size.width);
  if (!holds(luma, row_bytes, size.height) || !holds(colour, row_bytes, size.height / 2)) return {};
  cv::Mat image(mat_size({PixelKind::Nv12}, size), CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    const V4l2Plane& plane = y < size.height ? luma : colour;
    const auto row = static_cast<std::size_t>(y < size.height ? y : y - size.height);
    std::memcpy(image.ptr(y), plane.bytes.data() + row * plane.stride, row_bytes);
  }
  return image;
}

}  // namespace

cv::Mat v4l2_image(std::span<const V4l2Plane> planes, const V4l2Format& format, cv::Size size) {
  if (planes.empty()) throw std::invalid_argument("v4l2_image: needs a plane");
  if (format.pixels.kind == PixelKind::Jpeg) return jpeg(planes[0]);
  if (format.pixels.kind == PixelKind::Nv12) return nv12(planes, size);
  const std::size_t row_bytes = v4l2_row_bytes(format, size.width);
  if (!holds(planes[0], row_bytes, size.height)) return {};
  cv::Mat image(size, mat_type(format.pixels));
  for (int y = 0; y < size.height; ++y) {
    const std::uint8_t* row = planes[0].bytes.data() + static_cast<std::size_t>(y) * planes[0].stride;
    if (format.packing == V4l2Packing::Mipi10) {
      unpack_mipi10(row, size.width, image.ptr<std::uint16_t>(y));
    } else {
      copy_row(row, row_bytes, format.packing, image.ptr(y));
    }
  }
  return image;
}

}  // namespace alidade
