// SPDX-License-Identifier: Apache-2.0
#include "datasets/rendered_scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "datasets/furnished_room.h"
#include "geometry/pose.h"

namespace alidade {
namespace {

// On the table's front, turned to the camera of the first frame.
Eigen::Isometry3d place_marker(const RenderedSceneOptions& options) {
  const Eigen::Vector3d eye = camera_on_path(options.path, options.speed_m_s, 0).translation();
  const Eigen::Vector3d place(0.0, -0.3, kTableTop_m + 0.8 * options.marker_m);
  Eigen::Isometry3d T_world_marker = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d to_viewer = (eye - place).normalized();
  const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(to_viewer).normalized();
  T_world_marker.linear().col(0) = right;
  T_world_marker.linear().col(1) = to_viewer.cross(right);
  T_world_marker.linear().col(2) = to_viewer;
  T_world_marker.translation() = place;
  return T_world_marker;
}

// Texels a little finer than what a pixel of the supersampled picture sees from the usual distance.
double texel_for(const RenderedSceneOptions& options) {
  constexpr double kUsualDistance_m = 1.4;
  return std::clamp(kUsualDistance_m / (options.camera.fx * std::min(options.supersampling, 2)), 0.0006, 0.003);
}

void add_noise(cv::Mat& image, double sigma_grey, std::uint64_t seed) {
  if (sigma_grey == 0) return;
  cv::RNG random(seed * 0x9E3779B97F4A7C15ULL + 12345);
  cv::Mat noise(image.size(), CV_32FC3), sum;
  random.fill(noise, cv::RNG::NORMAL, 0.0, sigma_grey);
  cv::add(image, noise, sum, cv::noArray(), CV_32FC3);
  sum.convertTo(image, CV_8UC3);
}

void require(bool good, const char* field, double value, const char* bound) {
  if (!good) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
}

}  // namespace

void validate(const RenderedSceneOptions& options) {
  if (const auto fault = find_fault(options.camera)) throw std::invalid_argument(*fault);
  require(options.frames >= 1, "frames", options.frames, ">= 1");
  require(options.fps_hz > 0 && options.fps_hz <= 1e6, "fps_hz", options.fps_hz, "> 0 and <= 1e6 Hz");
  require(options.speed_m_s >= 0 && options.speed_m_s <= 100, "speed_m_s", options.speed_m_s, "0..100 m/s");
  require(options.noise_grey >= 0 && options.noise_grey <= 255, "noise_grey", options.noise_grey, "0..255");
  require(options.exposure_s >= 0 && options.exposure_s * options.fps_hz <= 1, "exposure_s", options.exposure_s,
          ">= 0 s and not longer than a frame");
  require(options.supersampling >= 1 && options.supersampling <= 4, "supersampling", options.supersampling, "1..4");
  require(options.black_from >= 0, "black_from", options.black_from, ">= 0");
  require(options.black_count >= 0, "black_count", options.black_count, ">= 0");
  require(options.marker_m >= 0 && options.marker_m <= 0.5, "marker_m", options.marker_m, "0..0.5 m");
}

RenderedScene::RenderedScene(const RenderedSceneOptions& options) : options_(options) {
  validate(options);
  if (!is_pinhole(options.camera.distortion)) warp_.emplace(options.camera, options.supersampling);
  Scene room = make_furnished_room({texel_for(options), options.seed});
  if (const auto T = T_world_marker()) room.surfaces.push_back(make_marker(*T, options.marker_m));
  renderer_.show(room);
}

double RenderedScene::seconds(int i) const {
  if (i < 0 || i >= options_.frames) {
    throw std::invalid_argument(fmt::format("RenderedScene: frame must be in 0..{}, got {}", options_.frames - 1, i));
  }
  return i / options_.fps_hz;
}

Timestamp RenderedScene::time(int i) const {
  return Timestamp(from_seconds(seconds(i)));
}

Eigen::Isometry3d RenderedScene::T_world_camera(int i) const {
  return camera_on_path(options_.path, options_.speed_m_s, seconds(i));
}

cv::Mat RenderedScene::frame(int i) {
  const double time_s = seconds(i);
  const bool black = i >= options_.black_from && i - options_.black_from < options_.black_count;
  cv::Mat image = black ? cv::Mat::zeros(options_.camera.height, options_.camera.width, CV_8UC3) : expose(time_s);
  add_noise(image, options_.noise_grey, options_.seed * 1'000'003ULL + static_cast<std::uint64_t>(i));
  return image;
}

cv::Mat RenderedScene::depth(int i) {
  const Camera& pinhole = warp_ ? warp_->pinhole() : options_.camera;
  const cv::Mat depth = renderer_.render_depth(pinhole, T_world_camera(i));
  return warp_ ? warp_->distort_depth(depth) : depth;
}

Trajectory RenderedScene::truth() const {
  Trajectory trajectory;
  for (int i = 0; i < options_.frames; ++i) trajectory.push_back({time(i), T_world_camera(i), std::nullopt});
  return trajectory;
}

std::optional<Eigen::Isometry3d> RenderedScene::T_world_marker() const {
  if (options_.marker_m == 0) return std::nullopt;
  return place_marker(options_);
}

cv::Mat RenderedScene::draw(const Eigen::Isometry3d& T_world_camera) {
  if (!warp_) return renderer_.render(options_.camera, T_world_camera, options_.supersampling);
  return warp_->distort(renderer_.render(resized(warp_->pinhole(), options_.supersampling), T_world_camera, 1));
}

// About one step per pixel that the picture of the table moves.
int RenderedScene::exposure_steps(double time_s) const {
  constexpr double kDistance_m = 1.5;
  const double half = options_.exposure_s / 2;
  const auto at = [&](double t) { return camera_on_path(options_.path, options_.speed_m_s, t); };
  const Vector6d moved = difference(at(time_s - half), at(time_s + half));
  const double shift_px = options_.camera.fx * (moved.head<3>().norm() / kDistance_m + moved.tail<3>().norm());
  return std::clamp(static_cast<int>(std::ceil(shift_px)) + 1, 2, 24);
}

cv::Mat RenderedScene::expose(double time_s) {
  const auto at = [&](double t) { return camera_on_path(options_.path, options_.speed_m_s, t); };
  if (options_.exposure_s == 0) return draw(at(time_s));
  const int steps = exposure_steps(time_s);
  cv::Mat sum = cv::Mat::zeros(options_.camera.height, options_.camera.width, CV_32FC3);
  for (int k = 0; k < steps; ++k) {  // midpoints of equal parts, so that their mean is the timestamp
    const double offset_s = options_.exposure_s * ((k + 0.5) / steps - 0.5);
    cv::accumulate(draw(at(time_s + offset_s)), sum);
  }
  cv::Mat image;
  sum.convertTo(image, CV_8UC3, 1.0 / steps);
  return image;
}

}  // namespace alidade
