// SPDX-License-Identifier: Apache-2.0
#include "uav/video/dot_filter.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

constexpr int kCalm = 5;        // frames until the noise is known well enough to tell outliers from it
constexpr float kClip = 16.0f;  // a squared response counts at most this many variances, so that targets count little

// Peaks that stand in the stronger ones' shadow are left out.
std::vector<DotPeak> strongest(std::vector<DotPeak> peaks) {
  std::sort(peaks.begin(), peaks.end(),
            [](const DotPeak& a, const DotPeak& b) { return std::abs(a.response) > std::abs(b.response); });
  std::vector<DotPeak> kept;
  for (const DotPeak& peak : peaks) {
    const bool is_free = std::none_of(kept.begin(), kept.end(), [&](const DotPeak& other) {
      return cv::norm(peak.pixel - other.pixel) < 2.0 * other.sigma_px + 2.0;
    });
    if (is_free) kept.push_back(peak);
  }
  std::sort(kept.begin(), kept.end(), [](const DotPeak& a, const DotPeak& b) {
    return a.pixel.y != b.pixel.y ? a.pixel.y < b.pixel.y : a.pixel.x < b.pixel.x;
  });
  return kept;
}

bool is_peak(const cv::Mat& response, int x, int y) {
  const float value = std::abs(response.at<float>(y, x));
  for (int v = -1; v <= 1; ++v) {
    for (int u = -1; u <= 1; ++u) {
      if (std::abs(response.at<float>(y + v, x + u)) > value) return false;
    }
  }
  return true;
}

// The place of the parabola's summit through values at -1, 0 and 1, of which the middle one is the highest.
double summit(double before, double here, double after) {
  const double bend = before - 2.0 * here + after;
  return bend == 0.0 ? 0.0 : std::clamp(0.5 * (before - after) / bend, -0.5, 0.5);
}

cv::Point2d summit_at(const cv::Mat& response, int x, int y) {
  const double here = response.at<float>(y, x);
  return {x + summit(response.at<float>(y, x - 1), here, response.at<float>(y, x + 1)),
          y + summit(response.at<float>(y - 1, x), here, response.at<float>(y + 1, x))};
}

// Whether any of a row's squared responses exceeds its own bound: a loop that vectorises.
bool has_high(const float* response, const float* variance, int count, float threshold2) {
  int high = 0;
  for (int x = 0; x < count; ++x) high |= response[x] * response[x] > threshold2 * variance[x] ? 1 : 0;
  return high != 0;
}

}  // namespace

void validate(const DotFilterOptions& o) {
  const auto require = [](bool is_so, const char* what, double value) {
    if (!is_so) throw std::invalid_argument(fmt::format("{}, got {}", what, value));
  };
  for (const double sigma : o.sigmas_px)
    require(sigma >= 0.3 && sigma <= 10.0, "sigmas_px must be in [0.3, 10]", sigma);
  require(o.surround_px >= 5 && o.surround_px % 2 == 1, "surround_px must be odd and >= 5 px", o.surround_px);
  require(o.threshold > 0.0, "threshold must be > 0", o.threshold);
  require(o.memory_frames >= 2.0, "memory_frames must be >= 2", o.memory_frames);
  require(o.least_noise_grey > 0.0, "least_noise_grey must be > 0", o.least_noise_grey);
  require(o.border_px >= 1, "border_px must be >= 1 px", o.border_px);
}

DotFilter::DotFilter(const DotFilterOptions& options) : options_(options) {
  validate(options);
  for (const double sigma : options.sigmas_px) {
    const double gain2 = 1.0 / (4.0 * CV_PI * sigma * sigma) - std::pow(options.surround_px, -2);  // of white noise
    scales_.push_back({sigma, {}, {}, gain2 * options.least_noise_grey * options.least_noise_grey});
  }
}

std::vector<DotPeak> DotFilter::find(const cv::Mat& residual) {
  if (residual.type() != CV_32FC1) throw std::invalid_argument("DotFilter: residuals must be of 32-bit floats");
  cv::Mat surround;
  cv::blur(residual, surround, {options_.surround_px, options_.surround_px});
  std::vector<DotPeak> peaks;
  for (Scale& scale : scales_) {
    const int side = 2 * static_cast<int>(std::ceil(3.0 * scale.sigma_px)) + 1;
    cv::GaussianBlur(residual, scale.response, {side, side}, scale.sigma_px);
    scale.response -= surround;
    if (scale.variance.empty()) scale.variance = cv::Mat(residual.size(), CV_32FC1, cv::Scalar(scale.least_variance));
    if (scale.variance.size() != residual.size()) {
      throw std::invalid_argument("DotFilter: residuals must be of one size");
    }
    collect(scale, peaks);
  }
  ++seen_;
  for (Scale& scale : scales_) learn(scale);
  return strongest(std::move(peaks));
}

void DotFilter::learn(Scale& scale) const {
  const float share = static_cast<float>(std::max(1.0 / seen_, 1.0 / options_.memory_frames));
  const float clip = seen_ > kCalm ? kClip : 1e9f;
  const float least = static_cast<float>(scale.least_variance);
  for (int y = 0; y < scale.response.rows; ++y) {
    const float* response = scale.response.ptr<float>(y);
    float* variance = scale.variance.ptr<float>(y);
    for (int x = 0; x < scale.response.cols; ++x) {
      const float square = std::min(response[x] * response[x], clip * variance[x]);
      variance[x] = std::max(least, variance[x] + share * (square - variance[x]));
    }
  }
}

// Mean squared response about a pixel, leaving out what may be the dot itself, and what other dots add.
double DotFilter::local_variance(const Scale& scale, const cv::Point& pixel) const {
  const int reach = options_.surround_px, inner = static_cast<int>(std::ceil(4.0 * scale.sigma_px)) + 1;
  const cv::Rect area =
      cv::Rect(pixel.x - reach, pixel.y - reach, 2 * reach + 1, 2 * reach + 1) & cv::Rect({}, scale.response.size());
  double sum = 0.0;
  int count = 0;
  for (int y = area.y; y < area.br().y; ++y) {
    const float *response = scale.response.ptr<float>(y), *variance = scale.variance.ptr<float>(y);
    for (int x = area.x; x < area.br().x; ++x) {
      if (std::abs(x - pixel.x) <= inner && std::abs(y - pixel.y) <= inner) continue;
      sum += std::min(response[x] * response[x], kClip * variance[x]);
      ++count;
    }
  }
  return count > 0 ? sum / count : 0.0;
}

void DotFilter::collect(const Scale& scale, std::vector<DotPeak>& peaks) const {
  const float threshold2 = static_cast<float>(options_.threshold * options_.threshold);
  const int border = options_.border_px, width = scale.response.cols - 2 * border;
  for (int y = border; y < scale.response.rows - border; ++y) {
    const float *response = scale.response.ptr<float>(y), *variance = scale.variance.ptr<float>(y);
    if (!has_high(response + border, variance + border, width, threshold2)) continue;
    for (int x = border; x < border + width; ++x) {
      if (response[x] * response[x] <= threshold2 * variance[x] || !is_peak(scale.response, x, y)) continue;
      const double noise2 = std::max<double>(variance[x], local_variance(scale, {x, y}));
      const double height = response[x] / std::sqrt(noise2);
      if (std::abs(height) <= options_.threshold) continue;
      peaks.push_back({{x, y}, summit_at(scale.response, x, y), scale.sigma_px, height});
    }
  }
}

}  // namespace alidade
