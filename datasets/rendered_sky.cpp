// SPDX-License-Identifier: Apache-2.0
#include "datasets/rendered_sky.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "camera/rolling_shutter.h"
#include "datasets/drawn_dot.h"

namespace alidade {
namespace {

using Eigen::Vector2d;

// A mast sways at several frequencies at once, Hz.
constexpr std::array<double, 4> kSway_hz{0.31, 0.83, 1.9, 4.7};

const Receiver& receiver_of(const SkyScene& scene, std::size_t index) {
  const Receiver& receiver = scene.receivers.at(index);
  if (!receiver.camera) throw std::invalid_argument("SkyVideo: the receiver has no camera");
  if (scene.fps_hz.size() != scene.receivers.size()) throw std::invalid_argument("SkyVideo: one fps_hz per receiver");
  if (!(scene.fps_hz[index] > 0.0)) throw std::invalid_argument("SkyVideo: fps_hz must be > 0 Hz");
  if (scene.dots.size() != scene.paths.size()) throw std::invalid_argument("SkyVideo: one dot per path");
  return receiver;
}

// Five standard deviations of the sway, and what turning adds at the corners.
int margin_for(const Camera& camera, const SkyLook& look) {
  const double corner_px = 0.5 * std::hypot(camera.width, camera.height);
  return static_cast<int>(std::ceil(5.0 * (look.shake_px + look.shake_roll_rad * corner_px))) + 2;
}

std::vector<Eigen::Array3d> draw_phases(cv::RNG& random) {
  std::vector<Eigen::Array3d> phases(kSway_hz.size());
  for (Eigen::Array3d& wave : phases) {
    for (double& phase : wave) phase = random.uniform(0.0, 2.0 * CV_PI);
  }
  return phases;
}

void require(bool is_so, const char* field, const char* bound, double value) {
  if (!is_so) throw std::invalid_argument(fmt::format("{} must be {}, got {}", field, bound, value));
}

}  // namespace

void validate(const SkyLook& look) {
  validate(look.backdrop);
  require(look.blur_px >= 0.0, "blur_px", ">= 0 px", look.blur_px);
  require(look.read_noise >= 0.0, "read_noise", ">= 0 grey levels", look.read_noise);
  require(look.shot_noise >= 0.0, "shot_noise", ">= 0 grey levels", look.shot_noise);
  require(look.shake_px >= 0.0 && look.shake_px <= 20.0, "shake_px", "in [0, 20] px", look.shake_px);
  require(look.shake_roll_rad >= 0.0 && look.shake_roll_rad <= 0.05, "shake_roll_rad", "in [0, 0.05] rad",
          look.shake_roll_rad);
}

SkyVideo::SkyVideo(const SkyScene& scene, std::size_t receiver)
    : receiver_(receiver_of(scene, receiver)),
      fps_hz_(scene.fps_hz[receiver]),
      duration_s_(scene.duration_s),
      paths_(scene.paths),
      dots_(scene.dots),
      look_(scene.look),
      margin_px_(margin_for(*receiver_.camera, scene.look)),
      backdrop_(*receiver_.camera, receiver_.T_world_receiver, margin_px_, scene.look.backdrop),
      random_(scene.look.seed + 1000 * receiver) {
  validate(look_);
  phases_ = draw_phases(random_);
}

SkyVideo::Sway SkyVideo::sway_at(Timestamp own) const {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (std::size_t i = 0; i < kSway_hz.size(); ++i) {
    sum += (2.0 * CV_PI * kSway_hz[i] * to_seconds(own.time_since_epoch()) + phases_[i]).sin();
  }
  sum *= std::sqrt(2.0 / static_cast<double>(kSway_hz.size()));  // root mean square 1
  return {look_.shake_px * sum.head<2>().matrix(), look_.shake_roll_rad * sum[2]};
}

Vector2d SkyVideo::swayed(const Vector2d& pixel, const Sway& sway) const {
  const Vector2d middle(0.5 * (receiver_.camera->width - 1), 0.5 * (receiver_.camera->height - 1));
  return middle + Eigen::Rotation2Dd(sway.roll_rad) * (pixel - middle) + sway.shift_px;
}

std::optional<Vector2d> SkyVideo::steady_pixel(const TargetPath& path, Timestamp own) const {
  constexpr int kSteps = 3;  // a target moves little while the shutter rolls
  std::optional<Vector2d> pixel;
  Timestamp exposed = common_time(receiver_.clock, own);
  for (int i = 0; i < kSteps; ++i) {
    if (exposed < path.birth || exposed >= path.death) return std::nullopt;
    const auto projection =
        project(*receiver_.camera, receiver_.T_world_receiver.inverse() * position_at(path, exposed));
    if (!projection) return std::nullopt;
    pixel = projection->pixel;
    exposed = common_time(receiver_.clock, own) + from_seconds(row_time_s(*receiver_.camera, pixel->y()));
  }
  return pixel;
}

cv::Mat SkyVideo::backdrop(Timestamp own, const Sway& sway) const {
  const cv::Mat wide = backdrop_.picture(common_time(receiver_.clock, own));
  const cv::Size size(receiver_.camera->width, receiver_.camera->height);
  const cv::Point corner(margin_px_, margin_px_);
  if (look_.shake_px == 0.0 && look_.shake_roll_rad == 0.0) return wide(cv::Rect(corner, size)).clone();
  const Sway back{-(Eigen::Rotation2Dd(-sway.roll_rad) * sway.shift_px), -sway.roll_rad};
  const Vector2d origin = swayed({0.0, 0.0}, back), x = swayed({1.0, 0.0}, back) - origin,
                 y = swayed({0.0, 1.0}, back) - origin;
  const cv::Matx23d wide_of_frame(x.x(), y.x(), origin.x() + margin_px_, x.y(), y.y(), origin.y() + margin_px_);
  cv::Mat picture;
  cv::warpAffine(wide, picture, wide_of_frame, size, cv::INTER_CUBIC | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  return picture;
}

double SkyVideo::noise_at(double grey) const {
  constexpr double kRounding = 1.0 / 12.0;
  return std::sqrt(look_.read_noise * look_.read_noise + look_.shot_noise * std::max(0.0, grey) + kRounding);
}

cv::Mat SkyVideo::with_noise(const cv::Mat& picture) {
  cv::Mat noise(picture.size(), CV_32FC1), deviation, image;
  random_.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
  cv::sqrt(cv::max(picture, 0.0) * look_.shot_noise + look_.read_noise * look_.read_noise, deviation);
  cv::Mat(picture + noise.mul(deviation)).convertTo(image, CV_8UC1);
  return image;
}

std::optional<SkyFrame> SkyVideo::next() {
  const double own_s = next_frame_ / fps_hz_;
  if (own_s >= duration_s_) return std::nullopt;
  ++next_frame_;
  SkyFrame frame;
  frame.time = Timestamp(from_seconds(own_s));
  const Sway sway = sway_at(frame.time);
  cv::Mat picture = backdrop(frame.time, sway);
  const cv::Mat clear = picture.clone();
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    const auto steady = steady_pixel(paths_[i], frame.time);
    if (!steady) continue;
    const Vector2d pixel = swayed(*steady, sway);
    const DotLook& dot = dots_[i];
    if (!is_inside(*receiver_.camera, pixel, 0.5 * dot.size_px)) continue;
    const double behind =
        clear.at<float>(static_cast<int>(std::lround(pixel.y())), static_cast<int>(std::lround(pixel.x())));
    const double contrast = (dot.is_dark ? -1.0 : 1.0) * dot.snr * noise_at(behind);
    draw_dot(picture, {pixel, dot.size_px, contrast}, look_.blur_px);
    frame.sightings.push_back({paths_[i].target, pixel, *steady, dot.size_px, dot.snr});
  }
  frame.image = with_noise(picture);
  return frame;
}

}  // namespace alidade
