// SPDX-License-Identifier: Apache-2.0
#include "datasets/sky_scene.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>

#include <fmt/format.h>

namespace alidade {
namespace {

using Eigen::Vector3d;
using Random = std::mt19937_64;

constexpr double kCamera_m = 2.0;   // above the ground
constexpr double kLookUp = 0.72;    // of the image's height lies above the horizon
constexpr double kSpace_m = 40.0;   // half the side of the targets' space, and
constexpr double kHeight_m = 30.0;  // its middle's height
constexpr double kHalfHeight_m = 25.0;

void require(bool is_so, const char* field, const char* bound, double value) {
  if (!is_so) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
}

double even(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Camera camera_of(const SkySceneOptions& options) {
  Camera camera;
  camera.width = options.width;
  camera.height = options.height;
  camera.fx = camera.fy = options.focal_px;
  camera.cx = 0.5 * (options.width - 1);
  camera.cy = 0.5 * (options.height - 1);
  camera.readout_s = options.readout_s;
  return camera;
}

Receiver place_receiver(const SkySceneOptions& options, int index) {
  const double share = options.receivers > 1 ? static_cast<double>(index) / (options.receivers - 1) - 0.5 : 0.0;
  const double azimuth = share * options.arc_rad;
  const Vector3d out(std::cos(azimuth), std::sin(azimuth), 0.0);
  const double up_rad = std::atan((kLookUp - 0.5) * options.height / options.focal_px);
  Receiver receiver;
  receiver.id = index;
  receiver.name = fmt::format("camera{}", index + 1);
  receiver.camera = camera_of(options);
  receiver.T_world_receiver.translation() = options.range_m * out + kCamera_m * Vector3d::UnitZ();
  Eigen::Matrix3d R;
  R.col(2) = std::cos(up_rad) * -out + std::sin(up_rad) * Vector3d::UnitZ();
  R.col(0) = R.col(2).cross(Vector3d::UnitZ()).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  receiver.T_world_receiver.linear() = R;
  receiver.clock.offset_s = index * options.clock_offset_s;
  receiver.sigma = 0.5;
  return receiver;
}

std::optional<Eigen::Vector2d> pixel_of(const Receiver& receiver, const TargetPath& path, Timestamp time) {
  const auto reading = reading_of(receiver, position_at(path, time), time);
  if (!reading) return std::nullopt;
  return reading->value;
}

// Whether all cameras see it move, all the time.
bool is_seen_by_all(const SkyScene& scene, const TargetPath& path, double least_speed_px_s) {
  constexpr int kMoments = 9;
  constexpr double kMargin_px = 24.0, kStep_s = 0.1;
  for (int i = 0; i < kMoments; ++i) {
    const Timestamp time(from_seconds(scene.duration_s * i / (kMoments - 1)));
    for (const Receiver& receiver : scene.receivers) {
      const auto here = pixel_of(receiver, path, time), there = pixel_of(receiver, path, time + from_seconds(kStep_s));
      if (!here || !there || !is_inside(*receiver.camera, *here, kMargin_px)) return false;
      if ((*there - *here).norm() < least_speed_px_s * kStep_s) return false;
    }
  }
  return true;
}

TargetPath draw_path(const SkySceneOptions& options, double slowness, Random& random) {
  const double turn = even(random, 0.0, 2.0 * CV_PI), push = even(random, 0.0, 2.0 * CV_PI);
  const double speed = slowness * even(random, options.least_speed_m_s, options.greatest_speed_m_s);
  const double x = even(random, -kSpace_m, kSpace_m), y = even(random, -kSpace_m, kSpace_m);
  const double z = kHeight_m + even(random, -kHalfHeight_m, kHalfHeight_m);
  TargetPath path;
  path.v_world = {speed * std::cos(turn), speed * std::sin(turn), even(random, -0.1, 0.1) * speed};
  path.a_world = 0.1 * speed * Vector3d(std::cos(push), std::sin(push), 0.0);
  const double half_s = 0.5 * options.duration_s;  // the place drawn is that of half time
  path.p0_world = Vector3d(x, y, z) - half_s * path.v_world - 0.5 * half_s * half_s * path.a_world;
  path.birth = Timestamp(from_seconds(-1.0));
  path.death = Timestamp(from_seconds(options.duration_s + 1.0 + options.receivers * std::abs(options.clock_offset_s)));
  return path;
}

}  // namespace

void validate(const SkySceneOptions& o) {
  require(o.receivers >= 1, "receivers", ">= 1", o.receivers);
  require(o.range_m > kSpace_m, "range_m", "> 40 m", o.range_m);
  require(o.width >= 64, "width", ">= 64 px", o.width);
  require(o.height >= 64, "height", ">= 64 px", o.height);
  require(o.focal_px > 0.0, "focal_px", "> 0 px", o.focal_px);
  require(o.fps_hz > 0.0, "fps_hz", "> 0 Hz", o.fps_hz);
  require(o.readout_s >= 0.0, "readout_s", ">= 0 s", o.readout_s);
  require(o.duration_s > 0.0, "duration_s", "> 0 s", o.duration_s);
  require(o.least_speed_m_s > 0.0, "least_speed_m_s", "> 0 m/s", o.least_speed_m_s);
  require(o.greatest_speed_m_s >= o.least_speed_m_s, "greatest_speed_m_s", ">= least_speed_m_s", o.greatest_speed_m_s);
  require(o.least_speed_px_s >= 0.0, "least_speed_px_s", ">= 0 px/s", o.least_speed_px_s);
  for (const DotLook& dot : o.dots) {
    require(dot.size_px > 0.0 && dot.size_px <= 50.0, "size_px", "in (0, 50] px", dot.size_px);
    require(dot.snr >= 0.0, "snr", ">= 0", dot.snr);
  }
  validate(o.look);
}

SkyScene make_sky_scene(const SkySceneOptions& options) {
  validate(options);
  Random random(options.seed);
  SkyScene scene;
  for (int k = 0; k < options.receivers; ++k) {
    scene.receivers.push_back(place_receiver(options, k));
    scene.fps_hz.push_back(options.fps_hz / (1.0 + 0.01 * k));
  }
  scene.dots = options.dots;
  scene.look = options.look;
  scene.duration_s = options.duration_s;
  for (int i = 0; i < static_cast<int>(options.dots.size()); ++i) {
    double slowness = 1.0;
    TargetPath path = draw_path(options, slowness, random);
    while (!is_seen_by_all(scene, path, slowness * options.least_speed_px_s)) {
      path = draw_path(options, slowness *= 0.998, random);
    }
    path.target = i;
    scene.paths.push_back(path);
  }
  return scene;
}

}  // namespace alidade
