// SPDX-License-Identifier: Apache-2.0
#include "uav/video/moving_objects.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace alidade {
namespace {

cv::Mat to_grey(const cv::Mat& image) {
  if (image.type() == CV_8UC1) return image;
  if (image.type() != CV_8UC3)
    throw std::invalid_argument("MovingObjectDetector: images must have 8 bits, grey or BGR");
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

// The frame as the first one's camera would show it; itself where it sways less than can be seen.
cv::Mat steadied(const cv::Mat& grey, const Eigen::Isometry2d& T_image_first) {
  constexpr double kUnseen_px = 0.03;
  const Eigen::Vector2d corner(grey.cols, grey.rows);
  const double sway_px = std::max(T_image_first.translation().norm(), (T_image_first * corner - corner).norm());
  if (sway_px < kUnseen_px) return grey;
  const Eigen::Matrix<double, 2, 3> T = T_image_first.matrix().topRows<2>();
  const cv::Matx23d map(T(0, 0), T(0, 1), T(0, 2), T(1, 0), T(1, 1), T(1, 2));
  cv::Mat steady;
  cv::warpAffine(grey, steady, map, grey.size(), cv::INTER_CUBIC | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  return steady;
}

std::vector<cv::Rect> areas_of(const std::vector<DotPeak>& peaks) {
  std::vector<cv::Rect> areas;
  for (const DotPeak& peak : peaks) {
    const int reach = static_cast<int>(std::ceil(3.0 * peak.sigma_px));
    areas.emplace_back(peak.pixel.x - reach, peak.pixel.y - reach, 2 * reach + 1, 2 * reach + 1);
  }
  return areas;
}

std::vector<SeenDot> sightings_of(const std::vector<DotPeak>& peaks) {
  std::vector<SeenDot> sightings;
  for (const DotPeak& peak : peaks) sightings.push_back({{peak.summit.x, peak.summit.y}, peak.response});
  return sightings;
}

}  // namespace

void validate(const MovingObjectOptions& o) {
  validate(o.stabiliser);
  validate(o.background);
  validate(o.filter);
  validate(o.fit);
  validate(o.tracks);
  if (o.warm_up_frames < 2) {
    throw std::invalid_argument(fmt::format("warm_up_frames must be >= 2, got {}", o.warm_up_frames));
  }
  if (!(o.lens_blur_px >= 0.0)) {
    throw std::invalid_argument(fmt::format("lens_blur_px must be >= 0 px, got {}", o.lens_blur_px));
  }
  if (!(o.systematic_px >= 0.0)) {
    throw std::invalid_argument(fmt::format("systematic_px must be >= 0 px, got {}", o.systematic_px));
  }
}

MovingObjectDetector::MovingObjectDetector(const MovingObjectOptions& options)
    : options_(options),
      stabiliser_(options.stabiliser),
      background_(options.background),
      filter_(options.filter),
      tracks_(options.tracks) {
  validate(options);
}

std::vector<MovingObject> MovingObjectDetector::detect(const cv::Mat& image, Timestamp time) {
  const cv::Mat grey = to_grey(image);
  Eigen::Isometry2d T_image_first = Eigen::Isometry2d::Identity();
  if (options_.is_swaying) T_image_first = stabiliser_.follow(grey).value_or(T_image_first);
  const cv::Mat residual = background_.residual(steadied(grey, T_image_first));
  const std::vector<DotPeak> peaks = filter_.find(residual);
  const bool is_warm = ++frames_ > options_.warm_up_frames;
  background_.learn(residual, is_warm ? areas_of(peaks) : std::vector<cv::Rect>{});
  if (2 * frames_ < options_.warm_up_frames) return {};
  const std::vector<bool> moves_on = tracks_.confirm(sightings_of(peaks), time);
  if (!is_warm) return {};
  std::vector<MovingObject> objects;
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    if (!moves_on[i]) continue;
    if (const auto object = fit(residual, peaks[i], T_image_first)) objects.push_back(*object);
  }
  return objects;
}

std::optional<MovingObject> MovingObjectDetector::fit(const cv::Mat& residual, const DotPeak& peak,
                                                      const Eigen::Isometry2d& T_image_first) const {
  const auto dot = fit_dot(residual, peak, options_.fit);
  if (!dot) return std::nullopt;
  MovingObject object;
  object.pixel = dot->pixel;
  object.covariance = dot->covariance + options_.systematic_px * options_.systematic_px * Eigen::Matrix2d::Identity();
  if (options_.is_swaying) {
    object.pixel = stabiliser_.mean_pixel(dot->pixel);
    object.covariance += stabiliser_.mean_covariance();
  }
  object.frame_pixel = T_image_first * dot->pixel;
  object.size_px = disc_diameter_px(dot->sigma_px, options_.lens_blur_px);
  object.snr = dot->height_grey / dot->noise_grey;
  return object;
}

std::vector<ReceiverReading> readings_of(std::span<const MovingObject> objects, int receiver, Timestamp time) {
  std::vector<ReceiverReading> readings;
  for (const MovingObject& object : objects) {
    readings.push_back({time, receiver, object.pixel, object.covariance});
  }
  return readings;
}

}  // namespace alidade
