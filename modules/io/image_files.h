// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <opencv2/core/mat.hpp>

namespace alidade {

/// An image of 8 bits, grey or BGR as it was stored, in the orientation of the sensor (EXIF's is ignored, as the
/// camera's intrinsics know nothing of it). Throws InputError where the file is missing, no image, cut off or damaged,
/// or has 16 bits.
cv::Mat read_image(const std::filesystem::path& path);

/// A depth image: 16 bits, one channel, in the data's own unit, 0 where nothing was measured. Throws as read_image.
cv::Mat read_depth(const std::filesystem::path& path);

/// A line image, whose rows are successive exposures of a linear detector: 8 or 16 bits, one or three channels. Throws
/// as read_image.
cv::Mat read_line_image(const std::filesystem::path& path);

/// Writes PNG or JPEG as the name ends; the file appears whole or not at all. Throws DeviceError where the file system
/// refuses, std::invalid_argument for another ending or an empty image.
void write_image(const std::filesystem::path& path, const cv::Mat& image);

/// Whether the name ends like an image that read_image reads (.jpg, .jpeg, .png, .bmp, .pgm, .ppm, .tif, .tiff, .webp).
bool has_image_extension(const std::filesystem::path& path);

}  // namespace alidade
