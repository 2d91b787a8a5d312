// SPDX-License-Identifier: Apache-2.0
#include "calib/boards/saddle_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include <Eigen/LU>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

using Eigen::Vector2d;

constexpr double kPi = std::numbers::pi;
constexpr double kSmoothing_px = 1.2;
constexpr float kLeastStrength = 1;  // grey levels / px²: two edges of 5 levels
constexpr std::size_t kMostPeaks = 3000;
// The wider, the truer the directions; the closer, the smaller the squares may be.
constexpr std::array<double, 4> kRadii_px{2.8, 4.2, 6, 9};
constexpr int kFarthest_px = 4;             // of a saddle from the peak
constexpr int kRim = 9 + kFarthest_px + 2;  // px added at the image's border: the widest ring must fit

// -det of the Hessian by central differences.
cv::Mat saddle_response(const cv::Mat& smooth) {
  cv::Mat response(smooth.size(), CV_32F, cv::Scalar(0));
  for (int y = 1; y + 1 < smooth.rows; ++y) {
    const auto *above = smooth.ptr<float>(y - 1), *here = smooth.ptr<float>(y), *below = smooth.ptr<float>(y + 1);
    auto* result = response.ptr<float>(y);
    for (int x = 1; x + 1 < smooth.cols; ++x) {
      const float xx = here[x - 1] - 2 * here[x] + here[x + 1];
      const float yy = above[x] - 2 * here[x] + below[x];
      const float xy = 0.25F * (above[x - 1] - above[x + 1] - below[x - 1] + below[x + 1]);
      result[x] = xy * xy - xx * yy;
    }
  }
  return response;
}

struct Peak {
  cv::Point pixel;
  float response;
};

bool is_largest_around(const cv::Mat& response, const cv::Point& p) {
  const float value = response.at<float>(p);
  for (int y = p.y - 2; y <= p.y + 2; ++y) {
    const auto* row = response.ptr<float>(y);
    for (int x = p.x - 2; x <= p.x + 2; ++x) {
      if (row[x] > value) return false;
    }
  }
  return true;
}

std::vector<Peak> strongest_peaks(const cv::Mat& response) {
  std::vector<Peak> peaks;
  for (int y = kRim; y + kRim < response.rows; ++y) {
    const auto* row = response.ptr<float>(y);
    for (int x = kRim; x + kRim < response.cols; ++x) {
      if (row[x] < kLeastStrength * kLeastStrength || row[x] < row[x - 1] || row[x] < row[x + 1]) continue;
      if (is_largest_around(response, {x, y})) peaks.push_back({{x, y}, row[x]});
    }
  }
  std::ranges::sort(peaks, std::ranges::greater{}, &Peak::response);
  if (peaks.size() > kMostPeaks) peaks.resize(kMostPeaks);
  return peaks;
}

// The step to where the gradient vanishes, by Newton; empty where that is no saddle.
std::optional<Vector2d> newton_step(const cv::Mat& smooth, const cv::Point& p) {
  const auto at = [&](int x, int y) { return static_cast<double>(smooth.at<float>(p.y + y, p.x + x)); };
  const Vector2d gradient(0.5 * (at(1, 0) - at(-1, 0)), 0.5 * (at(0, 1) - at(0, -1)));
  const double xy = 0.25 * (at(1, 1) - at(-1, 1) - at(1, -1) + at(-1, -1));
  Eigen::Matrix2d hessian;
  hessian << at(1, 0) - 2 * at(0, 0) + at(-1, 0), xy, xy, at(0, 1) - 2 * at(0, 0) + at(0, -1);
  if (!(hessian.determinant() < 0)) return std::nullopt;
  return -hessian.inverse() * gradient;
}

// The saddle near a peak of the response, which lies beside it where the edges cross aslant.
std::optional<Vector2d> saddle_near(const cv::Mat& smooth, const cv::Point& peak) {
  constexpr int kMostSteps = 5;
  constexpr double kMostStep_px = 2, kLastStep_px = 1.5;
  const Vector2d start(peak.x, peak.y);
  Vector2d place = start;
  double length_px = 0;
  for (int i = 0; i < kMostSteps; ++i) {
    const cv::Point pixel(cvRound(place.x()), cvRound(place.y()));
    const auto step = newton_step(smooth, pixel);
    if (!step) return std::nullopt;
    length_px = step->norm();
    place = Vector2d(pixel.x, pixel.y) + *step * std::min(1.0, kMostStep_px / length_px);
    if ((place - start).norm() > kFarthest_px) return std::nullopt;
    if (length_px < 1) return place;  // the pixel's own saddle, or nearly so
  }
  return length_px < kLastStep_px ? std::optional(place) : std::nullopt;
}

double interpolated(const cv::Mat& smooth, const Vector2d& p) {
  const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
  const double u = p.x() - x, v = p.y() - y;
  const auto *upper = smooth.ptr<float>(y) + x, *lower = smooth.ptr<float>(y + 1) + x;
  return (1 - v) * ((1 - u) * upper[0] + u * upper[1]) + v * ((1 - u) * lower[0] + u * lower[1]);
}

constexpr int kRingSamples = 32;
using Edges = std::array<double, 2>;
using Ring = std::array<double, kRingSamples>;

// Grey about `centre`, from x towards y, less the mean of the brightest and the darkest; empty where these are alike.
std::optional<Ring> sample_ring(const cv::Mat& smooth, const Vector2d& centre, double radius_px) {
  constexpr double kLeastContrast = 6;  // grey levels
  static const auto directions = [] {
    std::array<Vector2d, kRingSamples> result;
    for (int i = 0; i < kRingSamples; ++i) {
      const double angle_rad = 2 * kPi * i / kRingSamples;
      result[i] = {std::cos(angle_rad), std::sin(angle_rad)};
    }
    return result;
  }();
  Ring ring;
  for (int i = 0; i < kRingSamples; ++i) ring[i] = interpolated(smooth, centre + radius_px * directions[i]);
  const auto [least, most] = std::ranges::minmax(ring);
  if (most - least < kLeastContrast) return std::nullopt;
  for (double& value : ring) value -= 0.5 * (least + most);
  return ring;
}

// The mean of two directions that are nearly opposite, in [0, pi); empty where they are not.
std::optional<double> line_through(double one_rad, double other_rad) {
  constexpr double kMostBend_rad = 0.6;
  const double bend_rad = other_rad - one_rad - kPi;
  if (std::abs(bend_rad) > kMostBend_rad) return std::nullopt;
  const double direction_rad = std::fmod(one_rad + 0.5 * bend_rad + kPi, kPi);
  return direction_rad;
}

// Of a ring that changes its sign four times, opposite each other.
std::optional<Edges> crossing_edges(const Ring& ring) {
  constexpr double kLeastAngle_rad = 0.25;  // between edges
  std::array<double, 4> crossings_rad{};
  std::size_t count = 0;
  bool is_first_rising = false;
  for (int i = 0; i < kRingSamples; ++i) {
    const double value = ring[i], next = ring[(i + 1) % kRingSamples];
    if ((value > 0) == (next > 0)) continue;
    if (count == crossings_rad.size()) return std::nullopt;
    if (count == 0) is_first_rising = next > 0;
    crossings_rad[count++] = 2 * kPi * (i + value / (value - next)) / kRingSamples;
  }
  if (count != crossings_rad.size()) return std::nullopt;
  const auto first = line_through(crossings_rad[0], crossings_rad[2]);
  const auto second = line_through(crossings_rad[1], crossings_rad[3]);
  if (!first || !second) return std::nullopt;
  const double angle_rad = std::abs(*first - *second);
  if (std::min(angle_rad, kPi - angle_rad) < kLeastAngle_rad) return std::nullopt;
  return is_first_rising ? std::array{*first, *second} : std::array{*second, *first};
}

// By the widest ring within the squares: the first that shows edges, and on as long as they go on straight.
std::optional<Edges> edges_at(const cv::Mat& smooth, const Vector2d& centre) {
  constexpr double kMostBend_rad = 0.35;
  std::optional<Edges> edges;
  for (const double radius_px : kRadii_px) {
    const auto ring = sample_ring(smooth, centre, radius_px);
    const auto further = ring ? crossing_edges(*ring) : std::nullopt;
    if (!edges) {
      edges = further;
    } else if (further && std::max(angle_between_lines((*edges)[0], (*further)[0]),
                                   angle_between_lines((*edges)[1], (*further)[1])) < kMostBend_rad) {
      edges = further;
    } else {
      break;
    }
  }
  return edges;
}

}  // namespace

double angle_between_lines(double one_rad, double other_rad) {
  const double angle_rad = std::abs(one_rad - other_rad);
  return std::min(angle_rad, kPi - angle_rad);
}

std::vector<SaddlePoint> find_saddle_points(const cv::Mat& grey) {
  if (grey.type() != CV_8UC1) {
    throw std::invalid_argument("find_saddle_points: the image must be grey, of 8 bits");
  }
  cv::Mat smooth;
  cv::copyMakeBorder(grey, smooth, kRim, kRim, kRim, kRim, cv::BORDER_REPLICATE);
  smooth.convertTo(smooth, CV_32F);
  cv::GaussianBlur(smooth, smooth, {}, kSmoothing_px);
  cv::Mat is_found(smooth.size(), CV_8U, cv::Scalar(0));  // where another saddle point would be the same
  std::vector<SaddlePoint> points;
  for (const Peak& peak : strongest_peaks(saddle_response(smooth))) {
    const auto centre = saddle_near(smooth, peak.pixel);
    if (!centre) continue;
    const cv::Point pixel(cvRound(centre->x()), cvRound(centre->y()));
    const auto edges = is_found.at<uchar>(pixel) ? std::nullopt : edges_at(smooth, *centre);
    if (!edges) continue;
    is_found(cv::Rect(pixel.x - 1, pixel.y - 1, 3, 3)).setTo(1);
    points.push_back({centre->array() - kRim, *edges, std::sqrt(peak.response)});
  }
  return points;
}

}  // namespace alidade
