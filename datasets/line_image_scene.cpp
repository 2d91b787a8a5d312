// SPDX-License-Identifier: Apache-2.0
#include "datasets/line_image_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "geometry/rotation.h"

namespace alidade {
namespace {

using std::numbers::pi;

constexpr int kBlocks = 3, kDetectorsOfBlock = 4;

// The block looks at (0, 0, 1): x right, y down, z forward.
Eigen::Isometry3d T_world_block(int block) {
  const double azimuth = 2.0 * pi * block / kBlocks + 0.3;
  const Eigen::Vector3d eye(3.0 * std::cos(azimuth), 3.0 * std::sin(azimuth), 1.2 + 0.5 * block);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d R;
  R.col(2) = (Eigen::Vector3d(0, 0, 1) - eye).normalized();
  R.col(0) = (-Eigen::Vector3d::UnitZ()).cross(R.col(2)).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  T.linear() = R;
  T.translation() = eye;
  return T;
}

LineDetector make_detector(int block, int k) {
  LineDetector detector;
  detector.id = kDetectorsOfBlock * block + k;
  detector.station = fmt::format("block {}", block);
  LineCamera lens;
  lens.width = 2048;
  lens.f = 1640.0 + 3.0 * detector.id;
  lens.c = 1023.5 + 5.0 * std::sin(static_cast<double>(detector.id));
  lens.k1 = -0.08;
  lens.k2 = 0.02;
  detector.model = lens;
  detector.T_world_station = T_world_block(block);
  detector.T_station_detector =
      Eigen::Translation3d(0.15 * (k - 1.5), 0.0, 0.0) * Eigen::AngleAxisd(k * pi / 4.0, Eigen::Vector3d::UnitZ());
  detector.sigma = 0.1;
  return detector;
}

// px; empty where the marker's image is not on the line.
std::optional<double> seen_at(const LineDetector& detector, const Eigen::Vector3d& p_world) {
  const auto projection = project(detector, p_world);
  const int width = std::get<LineCamera>(detector.model).width;
  if (!projection || projection->value < -0.5 || projection->value > width - 0.5) return std::nullopt;
  return projection->value;
}

bool is_lit(const MarkerSign& sign, int phase, int row) {
  return sign.code[static_cast<std::size_t>(phase + row) % sign.code.size()] == '1';
}

// Which markers something stands before, row by row: alike for all detectors of a block.
std::vector<std::vector<bool>> hidden_markers(const LineImageScene& scene, const LineDetector& detector, int rows) {
  std::seed_seq seeds{scene.seed, std::uint64_t{77}, static_cast<std::uint64_t>(detector.id / kDetectorsOfBlock)};
  std::mt19937_64 random(seeds);
  std::uniform_real_distribution<double> uniform;
  std::vector<bool> now(scene.signs.size());
  std::vector<std::vector<bool>> hidden;
  for (int row = 0; row < rows; ++row) {
    for (std::size_t m = 0; m < now.size(); ++m) {
      const double redrawn = uniform(random), covered = uniform(random);
      if (row == 0 || redrawn < 0.03) now[m] = covered < scene.hidden_share;
    }
    hidden.push_back(now);
  }
  return hidden;
}

// Light of a spot of height 1 that falls on pixel i: its Gaussian before the pixels, averaged over the pixel.
double light(double position_px, double spot_sigma_px, int i) {
  const double optics = std::sqrt(spot_sigma_px * spot_sigma_px - 1.0 / 12.0);
  const double scale = 1.0 / (std::numbers::sqrt2 * optics), u = i - position_px;
  const double integral = 0.5 * (std::erf((u + 0.5) * scale) - std::erf((u - 0.5) * scale));
  return integral * std::sqrt(2.0 * pi) * spot_sigma_px;
}

double ambient_light(const LineImageLook& look, int i, int width) {
  const double s = static_cast<double>(i) / width;
  return look.full_height * (look.ambient + look.gradient * (s + 0.2 * std::sin(2.0 * pi * 3.0 * s)));
}

double share(const MarkerSign& sign, int channel, int channels) {
  if (channels == 1) return 1.0;
  if (!sign.colour) return 1.0 / 3.0;
  const auto& colour = *sign.colour;
  return colour[static_cast<std::size_t>(channel)] / (colour[0] + colour[1] + colour[2]);
}

std::vector<double> light_of_row(const LineImageScene& scene, const std::vector<LineImageTruth>& row, int width,
                                 int channels) {
  std::vector<double> counts(static_cast<std::size_t>(width * channels));
  for (int i = 0; i < width * channels; ++i) {
    counts[static_cast<std::size_t>(i)] = ambient_light(scene.look, i / channels, width);
  }
  const int reach = static_cast<int>(std::ceil(7.0 * scene.look.spot_sigma_px));
  for (const LineImageTruth& truth : row) {
    if (!truth.is_lit || truth.is_hidden) continue;
    const auto sign =
        std::find_if(scene.signs.begin(), scene.signs.end(), [&](const MarkerSign& s) { return s.id == truth.marker; });
    const int centre = static_cast<int>(std::lround(truth.position_px));
    for (int i = std::max(0, centre - reach); i <= std::min(width - 1, centre + reach); ++i) {
      const double spot = scene.look.full_height * light(truth.position_px, scene.look.spot_sigma_px, i);
      for (int c = 0; c < channels; ++c) {
        counts[static_cast<std::size_t>(i * channels + c)] += spot * share(*sign, c, channels);
      }
    }
  }
  return counts;
}

}  // namespace

LineImageNoise noise_of(const LineImageLook& look) {
  const double variance = std::pow(look.full_height / look.snr, 2);
  LineImageNoise noise;
  noise.shot = look.shot_share * variance / look.full_height;
  const double ambient = look.full_height * (look.ambient + 0.5 * look.gradient);
  noise.read = std::sqrt(std::max(0.0, (1.0 - look.shot_share) * variance - noise.shot * ambient));
  return noise;
}

LineImageScene line_image_scene(const std::vector<std::string>& codes, std::uint64_t seed) {
  if (codes.size() != 4) throw std::invalid_argument(fmt::format("four codes are wanted, got {}", codes.size()));
  LineImageScene scene;
  scene.seed = seed;
  scene.body.name = "tetrahedron";
  std::mt19937_64 random(seed);
  for (int block = 0; block < kBlocks; ++block) {
    for (int k = 0; k < kDetectorsOfBlock; ++k) scene.detectors.push_back(make_detector(block, k));
  }
  constexpr double kCorners[4][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  std::uniform_real_distribution<double> disturbance(-0.15, 0.15);
  for (std::size_t m = 0; m < codes.size(); ++m) {
    const Eigen::Vector3d corner = Eigen::Vector3d(kCorners[m][0], kCorners[m][1], kCorners[m][2]) / std::sqrt(3.0);
    const Eigen::Vector3d moved(disturbance(random), disturbance(random), disturbance(random));
    const int id = static_cast<int>(m) + 1;
    scene.body.markers.push_back({id, 0.15 * (corner + moved)});
    scene.signs.push_back({id, codes[m], std::nullopt, std::nullopt});
    scene.phases.push_back(static_cast<int>(random() % codes[m].size()));
  }
  return scene;
}

Eigen::Isometry3d T_world_body_in_figures(double t) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << 0.5 * std::sin(2.0 * t), 0.4 * std::sin(2.7 * t + 1.0), 1.0 + 0.3 * std::sin(3.3 * t + 2.0);
  T.linear() = exp_so3({0.8 * std::sin(1.9 * t), 0.7 * std::sin(2.3 * t + 0.5), std::sin(1.4 * t + 1.0)});
  return T;
}

std::vector<std::vector<LineImageTruth>> line_image_truth(const LineImageScene& scene, const LineDetector& detector,
                                                          int rows) {
  const auto hidden = hidden_markers(scene, detector, rows);
  std::vector<std::vector<LineImageTruth>> truth(static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    const Eigen::Isometry3d T_world_body = T_world_body_in_figures(row / scene.rate_hz);
    for (std::size_t m = 0; m < scene.signs.size(); ++m) {
      const auto position = seen_at(detector, T_world_body * scene.body.markers[m].p_body);
      if (!position) continue;
      LineImageTruth seen;
      seen.marker = scene.signs[m].id;
      seen.is_lit = is_lit(scene.signs[m], scene.phases[m], row);
      seen.is_hidden = hidden[static_cast<std::size_t>(row)][m];
      seen.position_px = *position;
      truth[static_cast<std::size_t>(row)].push_back(seen);
    }
  }
  return truth;
}

cv::Mat render_line_image(const LineImageScene& scene, const LineDetector& detector, int rows) {
  const int width = std::get<LineCamera>(detector.model).width;
  const bool is_coloured = std::any_of(scene.signs.begin(), scene.signs.end(),
                                       [](const MarkerSign& sign) { return sign.colour.has_value(); });
  const int channels = is_coloured ? 3 : 1;
  const bool has_16_bits = scene.look.full_height > 200.0;
  const auto truth = line_image_truth(scene, detector, rows);
  const LineImageNoise noise = noise_of(scene.look);
  std::seed_seq seeds{scene.seed, std::uint64_t{5}, static_cast<std::uint64_t>(detector.id)};
  std::mt19937_64 random(seeds);
  std::normal_distribution<double> normal;
  cv::Mat image(rows, width, CV_MAKETYPE(has_16_bits ? CV_16U : CV_8U, channels));
  for (int row = 0; row < rows; ++row) {
    const auto counts = light_of_row(scene, truth[static_cast<std::size_t>(row)], width, channels);
    for (int i = 0; i < width * channels; ++i) {
      const double mean = counts[static_cast<std::size_t>(i)];
      const double value = mean + std::sqrt(noise.read * noise.read + noise.shot * mean) * normal(random);
      if (has_16_bits) {
        image.ptr<std::uint16_t>(row)[i] = cv::saturate_cast<std::uint16_t>(value);
      } else {
        image.ptr<std::uint8_t>(row)[i] = cv::saturate_cast<std::uint8_t>(value);
      }
    }
  }
  return image;
}

}  // namespace alidade
