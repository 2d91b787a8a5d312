// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/picture_source.h"

#include <array>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "capture/image_names.h"
#include "core/errors.h"
#include "io/image_files.h"
#include "tests/support/gige_camera/test_pattern.h"

namespace alidade::test {
namespace {

// Blue, green or red of the four pixels of a mosaic's tile, in rows.
std::array<int, 4> colours_of(BayerPattern pattern) {
  switch (pattern) {
    case BayerPattern::RGGB:
      return {2, 1, 1, 0};
    case BayerPattern::GRBG:
      return {1, 2, 0, 1};
    case BayerPattern::GBRG:
      return {1, 0, 2, 1};
    case BayerPattern::BGGR:
      return {0, 1, 1, 2};
  }
  return {};
}

cv::Mat mosaic(const cv::Mat& image, BayerPattern pattern) {
  if (image.channels() == 1) return image;
  const std::array<int, 4> colours = colours_of(pattern);
  std::vector<cv::Mat> planes;
  cv::split(image, planes);
  cv::Mat result(image.size(), CV_MAKETYPE(image.depth(), 1));
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const cv::Mat& plane = planes[static_cast<std::size_t>(colours[static_cast<std::size_t>(2 * (y % 2) + x % 2)])];
      result.at<std::uint8_t>(y, x) = plane.at<std::uint8_t>(y, x);
    }
  }
  return result;
}

cv::Mat laid_out(const cv::Mat& image, const PixelFormat& format) {
  cv::Mat result = image;
  if (format.kind == PixelKind::Bayer) result = mosaic(image, format.pattern);
  if (format.kind == PixelKind::Grey && image.channels() == 3) cv::cvtColor(image, result, cv::COLOR_BGR2GRAY);
  if (format.kind == PixelKind::Bgr && image.channels() == 1) cv::cvtColor(image, result, cv::COLOR_GRAY2BGR);
  if (format.bits > 8)
    result.convertTo(result, CV_16U, static_cast<double>(1U << static_cast<unsigned>(format.bits - 8)));
  return result.isContinuous() && result.data != image.data ? result : result.clone();
}

class Pattern : public PictureSource {
 public:
  std::optional<std::uint32_t> picture_at(std::uint64_t frame) const override {
    return static_cast<std::uint32_t>(frame);
  }

  cv::Mat picture(std::uint32_t number, const cv::Rect& region, const PixelFormat& format) override {
    return test_pattern(number, region.size(), format);
  }
};

class Folder : public PictureSource {
 public:
  Folder(const std::filesystem::path& folder, bool is_endless) : is_endless_(is_endless) {
    for (const std::filesystem::path& path : list_images(folder)) {
      pictures_.push_back(read_image(path));
      if (pictures_.back().size() != pictures_.front().size()) {
        throw InputError(path.string(), 0, "is of another size than the first image of the folder",
                         "keep images of one size there");
      }
    }
  }

  std::optional<std::uint32_t> picture_at(std::uint64_t frame) const override {
    if (!is_endless_ && frame >= pictures_.size()) return std::nullopt;
    return static_cast<std::uint32_t>(frame % pictures_.size());
  }

  cv::Mat picture(std::uint32_t number, const cv::Rect& region, const PixelFormat& format) override {
    return laid_out(pictures_.at(number)(region), format);
  }

 private:
  std::vector<cv::Mat> pictures_;
  bool is_endless_;
};

}  // namespace

std::unique_ptr<PictureSource> open_pattern() {
  return std::make_unique<Pattern>();
}

std::unique_ptr<PictureSource> open_picture_folder(const std::filesystem::path& folder, bool is_endless) {
  return std::make_unique<Folder>(folder, is_endless);
}

cv::Size picture_size(const std::filesystem::path& folder) {
  return read_image(list_images(folder).front()).size();
}

}  // namespace alidade::test
