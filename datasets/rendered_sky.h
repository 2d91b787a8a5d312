// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "camera/receiver.h"
#include "core/time.h"
#include "datasets/sky_backdrop.h"
#include "datasets/target_scene.h"

namespace alidade {

/// How a target looks from everywhere.
struct DotLook {
  double size_px = 4.0;  ///< diameter of its disc in the image
  double snr = 10.0;     ///< contrast of the disc to what is behind it, over the noise of a pixel there
  bool is_dark = true;
};

/// How the videos look.
struct SkyLook {
  SkyBackdropOptions backdrop;
  double blur_px = 0.5;         ///< standard deviation of the lens' blur of the dots
  double read_noise = 1.0;      ///< standard deviation of a pixel's noise in the dark, grey levels
  double shot_noise = 0.02;     ///< what each grey level of brightness adds to the noise's variance, grey levels²
  double shake_px = 0.0;        ///< root mean square of each coordinate of the picture's swaying by wind
  double shake_roll_rad = 0.0;  ///< and of its turning about the image's middle
  unsigned seed = 1;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const SkyLook& look);

/// Standing cameras that film flying targets.
struct SkyScene {
  std::vector<Receiver> receivers;  ///< with cameras; T_world_receiver is where they look when they do not sway
  std::vector<double> fps_hz;       ///< of each receiver
  std::vector<TargetPath> paths;
  std::vector<DotLook> dots;  ///< of each path
  SkyLook look;
  double duration_s = 10.0;  ///< frames are taken while the receiver's own clock shows 0 to this
};

/// Where a target is in a frame.
struct DotSighting {
  int target = 0;                                          ///< TargetPath::target
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();         ///< in the frame
  Eigen::Vector2d steady_pixel = Eigen::Vector2d::Zero();  ///< where it would be, did the camera not sway
  double size_px = 0.0;
  double snr = 0.0;
};

/// A frame and what is true of it.
struct SkyFrame {
  Timestamp time{};                    ///< of its middle row, by the receiver's own clock
  cv::Mat image;                       ///< CV_8UC1
  std::vector<DotSighting> sightings;  ///< of the targets that are wholly in the image
};

/// Draws one receiver's video frame by frame. The same scene gives the same bytes.
/// Each target is where it is when its own row is exposed (rolling shutter); backdrop and sway are those of the frame's
/// time. Exposure is short: nothing is blurred by motion.
class SkyVideo {
 public:
  /// `receiver`: index into scene.receivers. Throws std::invalid_argument for a receiver without a camera, as many
  /// dots as paths missing, and as validate does.
  SkyVideo(const SkyScene& scene, std::size_t receiver);

  /// Empty at the end.
  std::optional<SkyFrame> next();

 private:
  struct Sway {
    Eigen::Vector2d shift_px;
    double roll_rad;
  };
  Sway sway_at(Timestamp own) const;
  std::optional<Eigen::Vector2d> steady_pixel(const TargetPath& path, Timestamp own) const;
  Eigen::Vector2d swayed(const Eigen::Vector2d& pixel, const Sway& sway) const;
  cv::Mat backdrop(Timestamp own, const Sway& sway) const;
  double noise_at(double grey) const;
  cv::Mat with_noise(const cv::Mat& picture);

  Receiver receiver_;
  double fps_hz_, duration_s_;
  std::vector<TargetPath> paths_;
  std::vector<DotLook> dots_;
  SkyLook look_;
  int margin_px_;
  SkyBackdrop backdrop_;
  std::vector<Eigen::Array3d> phases_;  // of the sway's waves: along x, along y, roll
  cv::RNG random_;
  int next_frame_ = 0;
};

}  // namespace alidade
