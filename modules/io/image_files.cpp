// SPDX-License-Identifier: Apache-2.0
#include "io/image_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "core/errors.h"
#include "io/atomic_file.h"
#include "io/image_integrity.h"
#include "io/jpeg_decoder.h"
#include "io/text_lines.h"

namespace alidade {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

cv::Mat decode(const std::filesystem::path& path, int flags) {
  const std::string bytes = read_bytes(path);
  if (bytes.empty()) throw InputError(path, 0, "is empty, an image is wanted", "copy the file again");
  if (const auto damage = find_image_damage(bytes)) throw InputError(path, 0, *damage, "copy the file again");
  if (is_jpeg(bytes)) {
    const auto jpeg = decode_jpeg(bytes);
    if (jpeg && jpeg->damage) throw InputError(path, 0, "is a damaged JPEG: " + *jpeg->damage, "copy the file again");
    if (jpeg) return jpeg->image;
  }
  const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
  cv::Mat image;
  try {
    image = cv::imdecode(encoded, flags | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) throw InputError(path, 0, "is no readable image", "PNG, JPEG, BMP, PNM, TIFF or WebP is wanted");
  return image;
}

}  // namespace

cv::Mat read_image(const std::filesystem::path& path) {
  const cv::Mat image = decode(path, cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH);
  if (image.depth() != CV_8U) throw InputError(path, 0, "has not 8 bits per channel", "convert the image to 8 bits");
  return image;
}

cv::Mat read_depth(const std::filesystem::path& path) {
  const cv::Mat depth = decode(path, cv::IMREAD_UNCHANGED);
  if (depth.type() != CV_16UC1) throw InputError(path, 0, "is no depth image", "16 bits and one channel are wanted");
  return depth;
}

cv::Mat read_line_image(const std::filesystem::path& path) {
  const cv::Mat image = decode(path, cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH);
  if (image.depth() == CV_8U || image.depth() == CV_16U) return image;
  throw InputError(path, 0, "has neither 8 nor 16 bits per channel", "convert the image to 16 bits");
}

void write_image(const std::filesystem::path& path, const cv::Mat& image) {
  const std::string extension = lower_extension(path);
  if (extension != ".png" && extension != ".jpg" && extension != ".jpeg") {
    throw std::invalid_argument("write_image: the name must end in .png or .jpg, got " + path.string());
  }
  if (image.empty()) throw std::invalid_argument("write_image: empty image");
  std::vector<unsigned char> bytes;
  if (!cv::imencode(extension, image, bytes)) throw std::invalid_argument("write_image: pixel type cannot be encoded");
  write_file(path, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

bool has_image_extension(const std::filesystem::path& path) {
  constexpr std::array kExtensions{".jpg", ".jpeg", ".png", ".bmp", ".pgm", ".ppm", ".tif", ".tiff", ".webp"};
  const std::string extension = lower_extension(path);
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

}  // namespace alidade
