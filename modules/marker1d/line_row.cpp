// SPDX-License-Identifier: Apache-2.0
#include "marker1d/line_row.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

namespace alidade {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

// Wide enough that a spot fills a small part of it, and narrow enough that ambient light is straight within.
constexpr Index kBlock_px = 64;

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> finite_values(const Eigen::Ref<const ArrayXd>& values) {
  std::vector<double> finite;
  finite.reserve(static_cast<std::size_t>(values.size()));
  for (const double value : values) {
    if (std::isfinite(value)) finite.push_back(value);
  }
  return finite;
}

struct Knot {
  double x, value;
};

// The straight line through the two knots about x, which goes on beyond the outermost.
double value_at(const std::vector<Knot>& knots, double x) {
  if (knots.size() == 1) return knots.front().value;
  std::size_t right = 1;
  while (right + 1 < knots.size() && knots[right].x < x) ++right;
  const Knot &a = knots[right - 1], &b = knots[right];
  return a.value + (b.value - a.value) * (x - a.x) / (b.x - a.x);
}

ArrayXd background(const Eigen::Ref<const ArrayXd>& values) {
  const Index width = values.size(), blocks = std::max<Index>(1, width / kBlock_px);
  std::vector<Knot> knots;
  for (Index b = 0; b < blocks; ++b) {
    const Index first = b * width / blocks, last = (b + 1) * width / blocks;
    auto block = finite_values(values.segment(first, last - first));
    if (!block.empty()) knots.push_back({0.5 * static_cast<double>(first + last - 1), median(block)});
  }
  ArrayXd result = ArrayXd::Zero(width);
  if (knots.empty()) return result;
  for (Index i = 0; i < width; ++i) result(i) = value_at(knots, static_cast<double>(i));
  return result;
}

// From the median absolute deviation, which a few spots do not move. `least`: what rounding to counts leaves unseen.
double noise_of(const Eigen::Ref<const ArrayXd>& signal, double least) {
  auto deviations = finite_values(signal.abs());
  return deviations.empty() ? least : std::max(least, 1.4826 * median(deviations));
}

LineRow prepare(const ArrayXXd& values, const PixelNoise& noise, double saturation, double least_noise) {
  LineRow row;
  row.shot = noise.shot;
  row.signal.resizeLike(values);
  row.variance.resizeLike(values);
  row.is_saturated = (values >= saturation).rowwise().any();
  row.is_usable = !row.is_saturated && values.isFinite().rowwise().all();
  for (Index c = 0; c < values.cols(); ++c) {
    const ArrayXd dark = background(values.col(c));
    row.signal.col(c) = values.col(c) - dark;
    const double own = noise_of(row.signal.col(c), least_noise);
    if (noise.read > 0) {
      row.variance.col(c) = noise.read * noise.read + noise.shot * dark.max(0.0);
    } else {
      row.variance.col(c).setConstant(own * own);
    }
  }
  row.signal = row.signal.isFinite().select(row.signal, 0.0);
  return row;
}

void require_noise(const PixelNoise& noise) {
  if (noise.read >= 0 && noise.shot >= 0 && std::isfinite(noise.read + noise.shot)) return;
  throw std::invalid_argument(
      fmt::format("PixelNoise must be finite and >= 0, got read {}, shot {}", noise.read, noise.shot));
}

template <class Value>
ArrayXXd values_of(const cv::Mat& row) {
  const int channels = row.channels();
  ArrayXXd values(row.cols, channels);
  const Value* pixel = row.ptr<Value>(0);
  for (Index i = 0; i < row.cols; ++i) {
    for (Index c = 0; c < channels; ++c) values(i, c) = static_cast<double>(*pixel++);
  }
  return values;
}

}  // namespace

LineRow prepare_row(const cv::Mat& row, const PixelNoise& noise, double saturation) {
  require_noise(noise);
  const bool is_line = row.dims == 2 && row.rows == 1 && row.cols > 0;
  const bool is_known = row.depth() == CV_8U || row.depth() == CV_16U;
  if (!is_line || !is_known || (row.channels() != 1 && row.channels() != 3)) {
    throw std::invalid_argument(
        fmt::format("a row must be 1 x N of 8 or 16 bits with one or three channels, got {} x {}, type {}", row.rows,
                    row.cols, cv::typeToString(row.type())));
  }
  const double largest = row.depth() == CV_8U ? 255.0 : 65535.0;
  const double kRounding = 1.0 / std::sqrt(12.0);
  return prepare(row.depth() == CV_8U ? values_of<std::uint8_t>(row) : values_of<std::uint16_t>(row), noise,
                 saturation > 0 ? saturation : largest, kRounding);
}

LineRow prepare_row(std::span<const float> row, const PixelNoise& noise, double saturation) {
  require_noise(noise);
  if (row.empty()) throw std::invalid_argument("a row must have pixels, got none");
  const ArrayXXd values =
      Eigen::Map<const Eigen::ArrayXf>(row.data(), static_cast<Index>(row.size())).cast<double>().matrix();
  // A row without any scatter has a noise all the same, else nothing could be weighed.
  auto finite = finite_values(values.col(0));
  const double range = finite.empty() ? 0.0
                                      : *std::max_element(finite.begin(), finite.end()) -
                                            *std::min_element(finite.begin(), finite.end());
  const double least = std::max(1e-6 * range, std::numeric_limits<float>::min() * 1.0);
  return prepare(values, noise, saturation > 0 ? saturation : std::numeric_limits<double>::infinity(), least);
}

}  // namespace alidade
