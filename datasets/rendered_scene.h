// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "camera/camera.h"
#include "core/time.h"
#include "datasets/camera_path.h"
#include "datasets/lens_warp.h"
#include "geometry/trajectory.h"
#include "view/renderer.h"

namespace alidade {

/// Options of a rendered sequence.
struct RenderedSceneOptions {
  Camera camera{640, 480, 520, 520, 319.5, 239.5, {}};
  int frames = 300;
  double fps_hz = 30.0;
  PathKind path = PathKind::Orbit;
  double speed_m_s = 0.4;   ///< of the centre (a slow walk); of PathKind::Rotation in rad/s
  double noise_grey = 2.0;  ///< standard deviation of the Gaussian pixel noise, grey levels: a good camera indoors
  double exposure_s = 0.0;  ///< motion blur: the frame is the mean over this time, centred at its timestamp
  int supersampling = 2;    ///< per side; 1 aliases
  int black_from = 0;       ///< first of black_count frames that show nothing, as if the lens were covered
  int black_count = 0;
  double marker_m = 0.0;  ///< side of an AprilTag 36h11 (id 0) on the table, facing the first frame; 0: none
  unsigned seed = 1;      ///< of textures and noise
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const RenderedSceneOptions& options);

/// A camera's flight through a furnished room, drawn frame by frame, with exact truth. Frames may be asked for in any
/// order; the same options give the same bytes on one machine.
class RenderedScene {
 public:
  /// Throws std::invalid_argument as validate does, or where the distortion cannot be drawn; DeviceError where nothing
  /// can draw here.
  explicit RenderedScene(const RenderedSceneOptions& options);

  const Camera& camera() const { return options_.camera; }
  int frame_count() const { return options_.frames; }

  /// i / fps from 0, in ns. Throws std::invalid_argument for a frame that is not there, as the next ones.
  Timestamp time(int i) const;
  Eigen::Isometry3d T_world_camera(int i) const;

  /// The image at time(i), CV_8UC3 (BGR), as the camera sees it: with distortion, blur and noise.
  cv::Mat frame(int i);

  /// Depth along the optical axis at the pixels' centres, CV_32FC1, m, without noise.
  cv::Mat depth(int i);

  /// The true poses of all frames, without covariance. World: z up, origin on the floor below the table, m.
  Trajectory truth() const;

  /// Where the marker is (OpenCV's axes: x right, y up, z towards the viewer); empty without one.
  std::optional<Eigen::Isometry3d> T_world_marker() const;

 private:
  cv::Mat expose(double time_s);
  cv::Mat draw(const Eigen::Isometry3d& T_world_camera);
  int exposure_steps(double time_s) const;
  double seconds(int i) const;

  RenderedSceneOptions options_;
  std::optional<LensWarp> warp_;  // only with distortion
  Renderer renderer_;
};

}  // namespace alidade
