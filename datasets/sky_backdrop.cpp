// SPDX-License-Identifier: Apache-2.0
#include "datasets/sky_backdrop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "datasets/procedural_texture.h"

namespace alidade {
namespace {

constexpr int kTexels = 1024;
constexpr double kTexelsPerUnit = 300.0;  // of the clouds' layer at unit height: clouds are smooth at the pixel's scale

// Octaves of smooth noise, each half as strong as the one before and half as large: the look of clouds. Periodic.
cv::Mat fractal_texture(cv::RNG& random) {
  cv::Mat sum = cv::Mat::zeros(kTexels, kTexels, CV_32FC1);
  double strength = 1.0;
  for (int cells = 8; cells <= kTexels / 4; cells *= 2, strength *= 0.55) {
    cv::Mat octave(cells, cells, CV_32FC1), ringed, fine;
    random.fill(octave, cv::RNG::NORMAL, 0.0, strength);
    const int texels_per_cell = kTexels / cells, ring = 4;
    cv::copyMakeBorder(octave, ringed, ring, ring, ring, ring, cv::BORDER_WRAP);
    cv::resize(ringed, fine, {}, texels_per_cell, texels_per_cell, cv::INTER_CUBIC);
    sum += fine(cv::Rect(ring * texels_per_cell, ring * texels_per_cell, kTexels, kTexels));
  }
  cv::Scalar mean, deviation;
  cv::meanStdDev(sum, mean, deviation);
  return (sum - mean[0]) / deviation[0];
}

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// Hills, and on them trees.
class Skyline {
 public:
  Skyline(double mean_rad, cv::RNG& random) : mean_rad_(mean_rad) {
    for (double& phase : phases_) phase = random.uniform(0.0, 2.0 * CV_PI);
  }

  double elevation_rad(double azimuth_rad) const {
    double height = 1.0, waves = 3.0, strength = 0.4;
    for (const double phase : phases_) {
      height += strength * std::sin(waves * azimuth_rad + phase);
      waves *= 2.3;
      strength *= 0.65;
    }
    return mean_rad_ * height;
  }

 private:
  double mean_rad_;
  std::array<double, 7> phases_;
};

// The ground is different in every direction that a camera may look.
unsigned seed_of(const SkyBackdropOptions& options, double heading_rad) {
  return options.seed + 17U * static_cast<unsigned>(std::lround(1000.0 * (heading_rad + 4.0)));
}

cv::Mat ground_texture(const SkyBackdropOptions& options, unsigned seed) {
  LeafTextureOptions leaves;
  leaves.size_m = {20.48, 2.56};
  leaves.texel_m = 0.01;
  leaves.smallest_m = 0.02;
  leaves.tone = cv::Vec3d::all(options.ground_grey);
  leaves.seed = seed;
  cv::Mat grey, texture;
  cv::cvtColor(leaf_texture(leaves), grey, cv::COLOR_BGR2GRAY);
  grey.convertTo(texture, CV_32FC1);
  return texture;
}

// The texel of a direction on the ground, `side_rad` from where the camera looks: finer towards the skyline, as in
// perspective.
cv::Point2f ground_texel(double side_rad, double below_skyline_rad) {
  constexpr double kNear_rad = 0.05, kRows = 70.0, kColumnsPerRad = 700.0, kMiddle = 1024.0;
  return {static_cast<float>(kMiddle + kColumnsPerRad * side_rad),
          static_cast<float>(kRows * std::log1p(std::max(0.0, below_skyline_rad) / kNear_rad))};
}

// Unit directions in the world of all pixels, CV_64FC3; up where the lens has none.
cv::Mat directions_of(const Camera& camera, const Eigen::Matrix3d& R_world_camera, int margin_px) {
  cv::Mat directions(camera.height + 2 * margin_px, camera.width + 2 * margin_px, CV_64FC3);
  for (int y = 0; y < directions.rows; ++y) {
    for (int x = 0; x < directions.cols; ++x) {
      const auto d_camera = unproject(camera, Eigen::Vector2d(x - margin_px, y - margin_px));
      const Eigen::Vector3d d = d_camera ? Eigen::Vector3d(R_world_camera * *d_camera) : Eigen::Vector3d::UnitZ();
      directions.at<cv::Vec3d>(y, x) = {d.x(), d.y(), d.z()};
    }
  }
  return directions;
}

struct StillView {
  cv::Mat picture;  // clear sky, and ground
  cv::Mat ground;   // its share of each pixel
};

StillView still_view(const cv::Mat& directions, double heading_rad, const Camera& camera,
                     const SkyBackdropOptions& options) {
  const unsigned seed = seed_of(options, heading_rad);
  cv::RNG random(seed);
  const Skyline skyline(options.skyline_rad, random);
  const cv::Size size = directions.size();
  cv::Mat sky(size, CV_32FC1), share(size, CV_32FC1), texel_x(size, CV_32FC1), texel_y(size, CV_32FC1), ground;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const cv::Vec3d& d = directions.at<cv::Vec3d>(y, x);
      const double side_rad = std::remainder(std::atan2(d[1], d[0]) - heading_rad, 2.0 * CV_PI);
      const double above_rad = std::asin(std::clamp(d[2], -1.0, 1.0)) - skyline.elevation_rad(side_rad);
      share.at<float>(y, x) = static_cast<float>(std::clamp(0.5 - above_rad * camera.fy, 0.0, 1.0));
      const double height = std::sqrt(std::max(0.0, d[2]));
      sky.at<float>(y, x) =
          static_cast<float>(options.horizon_grey + (options.zenith_grey - options.horizon_grey) * height);
      const cv::Point2f texel = ground_texel(side_rad, -above_rad);
      texel_x.at<float>(y, x) = texel.x;
      texel_y.at<float>(y, x) = texel.y;
    }
  }
  cv::remap(ground_texture(options, seed), ground, texel_x, texel_y, cv::INTER_LINEAR, cv::BORDER_REFLECT);
  return {sky + share.mul(ground - sky), share};
}

void require(bool is_so, const char* field, const char* bound, double value) {
  if (!is_so) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
}

bool is_grey(double value) {
  return value >= 0.0 && value <= 255.0;
}

}  // namespace

void validate(const SkyBackdropOptions& o) {
  require(is_grey(o.horizon_grey), "horizon_grey", "0..255", o.horizon_grey);
  require(is_grey(o.zenith_grey), "zenith_grey", "0..255", o.zenith_grey);
  require(is_grey(o.ground_grey), "ground_grey", "0..255", o.ground_grey);
  require(o.cloud_texture >= 0.0, "cloud_texture", ">= 0 grey levels", o.cloud_texture);
  require(o.cloud_cover >= 0.0 && o.cloud_cover <= 1.0, "cloud_cover", "in [0, 1]", o.cloud_cover);
  require(std::abs(o.wind_rad_s) < 1.0, "wind_rad_s", "within +-1 rad/s", o.wind_rad_s);
  require(o.skyline_rad >= 0.0 && o.skyline_rad < 0.5, "skyline_rad", "in [0, 0.5) rad", o.skyline_rad);
}

SkyBackdrop::SkyBackdrop(const Camera& camera, const Eigen::Isometry3d& T_world_camera, int margin_px,
                         const SkyBackdropOptions& options)
    : options_(options) {
  validate(options);
  if (const auto fault = find_fault(camera)) throw std::invalid_argument(*fault);
  cv::RNG random(options.seed);
  near_texture_ = fractal_texture(random);
  far_texture_ = fractal_texture(random);
  const Eigen::Matrix3d R_world_camera = T_world_camera.linear();
  const cv::Mat directions = directions_of(camera, R_world_camera, margin_px);
  const StillView still =
      still_view(directions, std::atan2(R_world_camera(1, 2), R_world_camera(0, 2)), camera, options);
  still_ = still.picture;
  for (cv::Mat* map : {&openness_, &cloud_x_, &cloud_y_}) map->create(directions.size(), CV_32FC1);
  for (int y = 0; y < directions.rows; ++y) {
    for (int x = 0; x < directions.cols; ++x) {
      const cv::Vec3d& d = directions.at<cv::Vec3d>(y, x);
      const double layer = kTexelsPerUnit / (std::max(0.0, d[2]) + 0.35);  // round: a plane would crowd at the horizon
      cloud_x_.at<float>(y, x) = static_cast<float>(layer * d[0]);
      cloud_y_.at<float>(y, x) = static_cast<float>(layer * d[1]);
      openness_.at<float>(y, x) =
          (1.0f - still.ground.at<float>(y, x)) * static_cast<float>(smooth_step(0.0, 0.25, d[2]));
    }
  }
}

cv::Mat SkyBackdrop::clouds(double drift, const cv::Mat& texture) const {
  const auto shift = [&](double along) { return kTexelsPerUnit * drift * along; };
  cv::Mat seen;
  cv::remap(texture, seen, cloud_x_ - shift(std::cos(options_.wind_azimuth_rad)),
            cloud_y_ - shift(std::sin(options_.wind_azimuth_rad)), cv::INTER_LINEAR, cv::BORDER_WRAP);
  return seen;
}

cv::Mat SkyBackdrop::picture(Timestamp common) const {
  const double drift = options_.wind_rad_s * to_seconds(common.time_since_epoch());
  const cv::Mat near = clouds(drift, near_texture_), far = clouds(0.5 * drift, far_texture_);
  cv::Mat picture = still_.clone();
  const float threshold = static_cast<float>(2.0 * (0.5 - options_.cloud_cover));
  for (int y = 0; y < picture.rows; ++y) {
    const float *n = near.ptr<float>(y), *f = far.ptr<float>(y), *open = openness_.ptr<float>(y);
    float* out = picture.ptr<float>(y);
    for (int x = 0; x < picture.cols; ++x) {
      const float t = std::clamp(0.5f + 0.8f * (0.7f * n[x] + 0.7f * f[x] - threshold), 0.0f, 1.0f);
      const float cloud = t * t * (3.0f - 2.0f * t);
      const float texture = static_cast<float>(options_.cloud_texture) * 0.7f * (n[x] - f[x]);
      out[x] += open[x] * cloud * (static_cast<float>(options_.cloud_grey) + texture);
    }
  }
  return picture;
}

}  // namespace alidade
