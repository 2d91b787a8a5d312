// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "camera/line_detector.h"
#include "camera/marker_sign.h"
#include "geometry/rigid_body.h"

namespace alidade {

/// How line images look.
struct LineImageLook {
  double snr = 10.0;           ///< height of a spot over the standard deviation of the noise of its highest pixel
  double spot_sigma_px = 1.2;  ///< of a spot's profile in the image, the pixel's own width included
  double full_height = 120.0;  ///< of a spot, counts; above 200 the images have 16 bits
  double shot_share = 0.5;     ///< of the variance of the highest pixel that is the spot's own shot noise
  double ambient = 0.2;        ///< light of the surroundings at the first pixel, in heights of a spot
  double gradient = 0.15;      ///< what comes to it by the last pixel, in waves of a fifth of that
};

/// Counts per electron and the standard deviation in the dark (counts) by which the images are made.
struct LineImageNoise {
  double shot = 0.0, read = 0.0;
};
LineImageNoise noise_of(const LineImageLook& look);

/// A body with blinking or coloured markers among linear detectors with lenses.
struct LineImageScene {
  std::vector<LineDetector> detectors;  ///< LineCamera
  RigidBody body;
  std::vector<MarkerSign> signs;  ///< of the body's markers, in their order
  std::vector<int> phases;        ///< which row of its code each marker shows in row 0, whatever `signs` says of it
  double rate_hz = 250.0;         ///< rows per second
  double hidden_share = 0.0;      ///< of the (block, marker) pairs, in bursts; redrawn with probability 0.03 per row
  std::uint64_t seed = 1;
  LineImageLook look;
};

/// The scene of the method's figures, with lenses: three blocks of four detectors (ids 0 … 11) of 2048 px and 64° with
/// some distortion, 3 m away; a tetrahedron of four markers (ids 1 … 4) with these codes, and phases drawn by `seed`;
/// signs[i].phase is empty. Throws std::invalid_argument where there are not four codes.
LineImageScene line_image_scene(const std::vector<std::string>& codes, std::uint64_t seed = 1);

/// Where the body of the figures is at `time_s`: 1 m around, all six degrees of freedom.
Eigen::Isometry3d T_world_body_in_figures(double time_s);

/// What is to be seen of one marker in one row.
struct LineImageTruth {
  int marker = 0;
  bool is_lit = false;     ///< by its code
  bool is_hidden = false;  ///< by something that stands before it
  double position_px = 0.0;
};

/// The markers in the detector's view in each row 0 … rows − 1.
std::vector<std::vector<LineImageTruth>> line_image_truth(const LineImageScene& scene, const LineDetector& detector,
                                                          int rows);

/// The image that the detector records: rows × width, 8 or 16 bits, three channels where the signs have colours. The
/// same for the same scene and detector.
cv::Mat render_line_image(const LineImageScene& scene, const LineDetector& detector, int rows);

}  // namespace alidade
