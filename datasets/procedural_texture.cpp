// SPDX-License-Identifier: Apache-2.0
#include "datasets/procedural_texture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

constexpr int kFractionBits = 4;

cv::Point to_fixed(double x, double y) {
  return {static_cast<int>(std::lround(x * (1 << kFractionBits))),
          static_cast<int>(std::lround(y * (1 << kFractionBits)))};
}

// Shades of the tone, from dark to light (features see brightness), with a little colour of their own.
cv::Scalar random_colour(cv::RNG& random, const cv::Vec3d& tone) {
  const double brightness = random.uniform(0.25, 1.6);
  cv::Scalar colour;
  for (int c = 0; c < 3; ++c) colour[c] = std::clamp(brightness * tone[c] + random.uniform(-28.0, 28.0), 5.0, 245.0);
  return colour;
}

// A closed figure of 3 to 7 corners, or of many: a disc.
void draw_figure(cv::Mat& texture, cv::RNG& random, double radius_px, const cv::Vec3d& tone) {
  const double x = random.uniform(0.0, 1.0) * texture.cols, y = random.uniform(0.0, 1.0) * texture.rows;
  const int kind = random.uniform(0, 6);
  const int corners = kind == 0 ? 24 : 2 + kind;
  const double flatness = random.uniform(0.45, 1.0), turn = random.uniform(0.0, 2.0 * std::numbers::pi);
  std::vector<cv::Point> outline;
  for (int i = 0; i < corners; ++i) {
    const double a = 2.0 * std::numbers::pi * i / corners;
    const double u = radius_px * std::cos(a), v = radius_px * flatness * std::sin(a);
    outline.push_back(
        to_fixed(x + u * std::cos(turn) - v * std::sin(turn), y + u * std::sin(turn) + v * std::cos(turn)));
  }
  cv::fillConvexPoly(texture, outline, random_colour(random, tone), cv::LINE_AA, kFractionBits);
}

// Adds noise of amplitude `grey` in octaves from 0.5 m down to 4 mm; all octaves alike.
void add_fractal_noise(cv::Mat& texture, cv::RNG& random, const LeafTextureOptions& options) {
  cv::Mat sum = cv::Mat::zeros(2, 2, CV_32FC1);
  for (double cell_m = 0.5; cell_m > 0.004; cell_m /= 2) {
    const cv::Size cells(std::max(2, static_cast<int>(std::ceil(options.size_m.x() / cell_m)) + 1),
                         std::max(2, static_cast<int>(std::ceil(options.size_m.y() / cell_m)) + 1));
    cv::Mat octave(cells, CV_32FC1), finer;
    random.fill(octave, cv::RNG::UNIFORM, -0.5 * options.noise_grey, 0.5 * options.noise_grey);
    cv::resize(sum, finer, cells, 0, 0, cv::INTER_LINEAR);
    sum = finer + octave;
  }
  cv::Mat fine, grey, noise;
  cv::resize(sum, fine, texture.size(), 0, 0, cv::INTER_LINEAR);
  fine.convertTo(grey, CV_16SC1);
  cv::merge(std::vector<cv::Mat>{grey, grey, grey}, noise);
  cv::add(texture, noise, texture, cv::noArray(), CV_8UC3);
}

}  // namespace

cv::Mat leaf_texture(const LeafTextureOptions& options) {
  const auto pixels = [&](double metres) {
    return std::max(8, static_cast<int>(std::lround(metres / options.texel_m)));
  };
  cv::RNG random(options.seed * 0x9E3779B97F4A7C15ULL + 1);
  cv::Mat texture(pixels(options.size_m.y()), pixels(options.size_m.x()), CV_8UC3,
                  cv::Scalar(options.tone[0], options.tone[1], options.tone[2]));
  const double area = options.size_m.x() * options.size_m.y();
  for (double radius = options.largest_m; radius >= options.smallest_m; radius /= std::numbers::sqrt2) {
    const double coverage = 0.5 * options.coverage * std::pow(radius / options.largest_m, 0.7);  // two sizes per octave
    const int count = static_cast<int>(std::ceil(coverage * area / (radius * radius)));
    for (int i = 0; i < count; ++i) {
      draw_figure(texture, random, radius * random.uniform(0.8, 1.2) / options.texel_m, options.tone);
    }
  }
  add_fractal_noise(texture, random, options);
  return texture;
}

}  // namespace alidade
