// SPDX-License-Identifier: Apache-2.0
#include "datasets/line_image_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/core/utility.hpp>

#include "core/find_by_id.h"

namespace alidade {
namespace {

using std::numbers::pi;

bool is_lit(const MarkerSign& sign, int phase, int row) {
  return sign.code[static_cast<std::size_t>(phase + row) % sign.code.size()] == '1';
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

int width_of(const LineDetector& detector) {
  return std::get<LineCamera>(detector.model).width;
}

// Draws one detector's rows.
class RowPainter {
 public:
  RowPainter(const LineImageScene& scene, const LineDetector& detector)
      : scene_(scene), detector_(detector.id), width_(width_of(detector)), noise_(noise_of(scene.look)) {
    const bool is_coloured =
        std::any_of(scene.signs.begin(), scene.signs.end(), [](const auto& sign) { return sign.colour.has_value(); });
    channels_ = is_coloured ? 3 : 1;
    for (int i = 0; i < width_ * channels_; ++i) dark_.push_back(ambient_light(scene.look, i / channels_, width_));
  }

  cv::Mat blank(int rows) const {
    constexpr double kHighestIn8Bits = 200.0;
    const int depth = scene_.look.full_height > kHighestIn8Bits ? CV_16U : CV_8U;
    return {rows, width_, CV_MAKETYPE(depth, channels_)};
  }

  void paint(const BodySceneFrame& frame, int row, cv::Mat line) const {
    std::vector<double> counts = dark_;
    for (const LineReading& reading : frame.readings) {
      if (reading.detector == detector_) add_spot(reading, counts);
    }
    std::seed_seq seeds{static_cast<int>(scene_.scene.seed), 5, detector_, row};
    std::mt19937_64 random(seeds);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const double sigma = std::sqrt(noise_.read * noise_.read + noise_.shot * counts[i]);
      const double value = counts[i] + sigma * normal(random);
      if (line.depth() == CV_16U) {
        line.ptr<std::uint16_t>(0)[i] = cv::saturate_cast<std::uint16_t>(value);
      } else {
        line.ptr<std::uint8_t>(0)[i] = cv::saturate_cast<std::uint8_t>(value);
      }
    }
  }

 private:
  void add_spot(const LineReading& reading, std::vector<double>& counts) const {
    const LineImageLook& look = scene_.look;
    const MarkerSign& sign = *find_by_id<MarkerSign>(scene_.signs, reading.marker);
    const int reach = static_cast<int>(std::ceil(7.0 * look.spot_sigma_px));
    const int centre = static_cast<int>(std::lround(reading.value));
    for (int i = std::max(0, centre - reach); i <= std::min(width_ - 1, centre + reach); ++i) {
      const double spot = look.full_height * light(reading.value, look.spot_sigma_px, i);
      for (int c = 0; c < channels_; ++c) {
        counts[static_cast<std::size_t>(i * channels_ + c)] += spot * share(sign, c, channels_);
      }
    }
  }

  const LineImageScene& scene_;
  int detector_, width_, channels_ = 1;
  LineImageNoise noise_;
  std::vector<double> dark_;  // counts of a row without spots
};

void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

}  // namespace

void validate(const LineImageLook& look) {
  require(look.snr >= 1 && look.snr <= 1e4, fmt::format("snr must be 1..10000, got {}", look.snr));
  require(look.spot_sigma_px >= 0.4 && look.spot_sigma_px <= 100,
          fmt::format("spot_sigma_px must be 0.4..100 px, got {}", look.spot_sigma_px));
  require(look.full_height > 0 && look.full_height <= 40000,
          fmt::format("full_height must be > 0 and <= 40000 counts, got {}", look.full_height));
}

LineImageNoise noise_of(const LineImageLook& look) {
  const double variance = std::pow(look.full_height / look.snr, 2);
  LineImageNoise noise;
  noise.shot = look.shot_share * variance / look.full_height;
  const double ambient = look.full_height * (look.ambient + 0.5 * look.gradient);
  noise.read = std::sqrt(std::max(0.0, (1.0 - look.shot_share) * variance - noise.shot * ambient));
  return noise;
}

double lone_spot_bound_px(const LineImageLook& look) {
  const LineImageNoise noise = noise_of(look);
  const double s = look.spot_sigma_px, dark = look.full_height * (look.ambient + 0.5 * look.gradient);
  constexpr double kStep_px = 0.1;
  double information = 0.0;
  for (double u = -8.0 * s; u <= 8.0 * s; u += kStep_px) {
    const double spot = look.full_height * std::exp(-0.5 * u * u / (s * s));
    const double variance = noise.read * noise.read + noise.shot * (dark + spot);
    information += kStep_px * std::pow(spot * u / (s * s), 2) / variance;
  }
  return 1.0 / std::sqrt(information);
}

LineImageScene line_image_scene(BodySceneOptions options, const std::vector<std::string>& codes,
                                const LineImageLook& look) {
  validate(look);
  require(options.wrong_ids == 0, "wrong_ids: in line images wrong ids arise from the images themselves");
  require(options.skew_s == 0, "skew_s: a row of a line image is exposed at once");
  options.has_lenses = true;
  options.sigma_px = 0;
  const BodyScene scene(options);
  const std::size_t markers = static_cast<std::size_t>(options.bodies * options.markers);
  require(codes.size() == markers, fmt::format("{} codes are wanted, got {}", markers, codes.size()));
  LineImageScene result{options, scene.detectors(), scene.bodies(), {}, {}, look};
  for (LineDetector& detector : result.detectors) detector.sigma = lone_spot_bound_px(look);
  std::mt19937_64 random(options.seed);
  for (const RigidBody& body : scene.bodies()) {
    for (const BodyMarker& marker : body.markers) {
      const std::string& code = codes[result.signs.size()];
      result.signs.push_back({marker.id, code, std::nullopt, std::nullopt});
      result.phases.push_back(static_cast<int>(random() % code.size()));
    }
  }
  return result;
}

LineImageRecording::LineImageRecording(const LineImageScene& scene) : scene_(scene), frames_(scene.scene) {}

std::optional<LineImageBlock> LineImageRecording::next(int rows) {
  LineImageBlock block;
  block.first_row = next_row_;
  while (static_cast<int>(block.frames.size()) < rows) {
    auto frame = next_frame(next_row_);
    if (!frame) break;
    block.frames.push_back(std::move(*frame));
    ++next_row_;
  }
  if (block.frames.empty()) return std::nullopt;
  block.images.resize(scene_.detectors.size());
  cv::parallel_for_(cv::Range(0, static_cast<int>(block.images.size())), [&](const cv::Range& range) {
    for (int d = range.start; d < range.end; ++d) {
      const RowPainter painter(scene_, scene_.detectors[static_cast<std::size_t>(d)]);
      cv::Mat image = painter.blank(static_cast<int>(block.frames.size()));
      for (int row = 0; row < image.rows; ++row) {
        painter.paint(block.frames[static_cast<std::size_t>(row)], block.first_row + row, image.row(row));
      }
      block.images[static_cast<std::size_t>(d)] = image;
    }
  });
  return block;
}

// What is lit, of the detectors that record.
std::optional<BodySceneFrame> LineImageRecording::next_frame(int row) {
  const auto all = frames_.next();
  if (!all) return std::nullopt;
  const double sigma = lone_spot_bound_px(scene_.look);
  BodySceneFrame frame{all->time, {}, {}};
  for (LineReading reading : all->readings) {
    const MarkerSign* sign = find_by_id<MarkerSign>(scene_.signs, reading.marker);
    const int phase = scene_.phases[static_cast<std::size_t>(sign - scene_.signs.data())];
    if (!is_lit(*sign, phase, row) || !find_by_id<LineDetector>(scene_.detectors, reading.detector)) continue;
    reading.sigma = sigma;
    frame.readings.push_back(reading);
    frame.is_right.push_back(true);
  }
  return frame;
}

BodySceneFrame disturbed(BodySceneFrame frame, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  for (LineReading& reading : frame.readings) reading.value += reading.sigma * normal(random);
  return frame;
}

}  // namespace alidade
