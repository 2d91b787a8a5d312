// SPDX-License-Identifier: Apache-2.0
#include "tests/support/gige_camera/test_pattern.h"

#include <cstring>
#include <random>
#include <vector>

namespace alidade::test {
namespace {

// The noise of a row is a stretch of this many values, repeated; a prime, so that rows and pictures do not fall into
// step with packets.
constexpr std::size_t kPeriod = 8191;
constexpr std::size_t kStepPerRow = 577;
constexpr std::size_t kStepPerPicture = 2741;

template <typename T>
const std::vector<T>& noise() {
  static const std::vector<T> values = [] {
    std::mt19937 random(20240229);
    std::vector<T> drawn(kPeriod);
    for (T& value : drawn) value = static_cast<T>(random());
    return drawn;
  }();
  return values;
}

template <typename T>
void fill_row(std::span<T> row, std::size_t start, int bits) {
  const std::vector<T>& source = noise<T>();
  for (std::size_t at = 0; at < row.size();) {
    const std::size_t from = (start + at) % kPeriod;
    const std::size_t count = std::min(row.size() - at, kPeriod - from);
    std::memcpy(row.data() + at, source.data() + from, count * sizeof(T));
    at += count;
  }
  if (bits == 8 * static_cast<int>(sizeof(T))) return;
  const T mask = static_cast<T>((1U << static_cast<unsigned>(bits)) - 1U);
  for (T& value : row) value &= mask;
}

template <typename T>
void draw(cv::Mat& image, std::uint32_t number, int bits) {
  const std::size_t values = static_cast<std::size_t>(image.cols) * static_cast<std::size_t>(image.channels());
  for (int y = 0; y < image.rows; ++y) {
    const std::size_t start =
        (static_cast<std::size_t>(number) * kStepPerPicture + static_cast<std::size_t>(y) * kStepPerRow);
    fill_row(std::span(image.ptr<T>(y), values), start % kPeriod, bits);
  }
  if (image.cols < kNumberPixels) return;
  T* const first = image.ptr<T>(0);
  const int channels = image.channels();
  for (int i = 0; i < kNumberPixels * channels; ++i) {
    const bool is_set = ((number >> static_cast<unsigned>(kNumberPixels - 1 - i / channels)) & 1U) != 0;
    first[i] = is_set ? static_cast<T>((1U << static_cast<unsigned>(bits)) - 1U) : T{0};
  }
}

template <typename T>
std::uint32_t read_number(const cv::Mat& image, int bits) {
  std::uint32_t number = 0;
  for (int x = 0; x < kNumberPixels; ++x) {
    const T value = image.ptr<T>(0)[x * image.channels()];
    number = number << 1U | ((value >> static_cast<unsigned>(bits - 1)) & 1U);
  }
  return number;
}

}  // namespace

cv::Mat test_pattern(std::uint32_t number, cv::Size size, const PixelFormat& format) {
  cv::Mat image(mat_size(format, size), mat_type(format));
  if (image.depth() == CV_8U) {
    draw<std::uint8_t>(image, number, format.bits);
  } else {
    draw<std::uint16_t>(image, number, format.bits);
  }
  return image;
}

std::optional<std::uint32_t> number_in_pattern(const cv::Mat& image, const PixelFormat& format) {
  if (image.cols < kNumberPixels || image.rows < 1) return std::nullopt;
  return image.depth() == CV_8U ? read_number<std::uint8_t>(image, format.bits)
                                : read_number<std::uint16_t>(image, format.bits);
}

}  // namespace alidade::test
