// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "camera/marker_sign.h"
#include "datasets/body_scene.h"

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

/// Throws std::invalid_argument naming field, value and bound.
void validate(const LineImageLook& look);

/// Counts per electron and the standard deviation in the dark (counts) by which the images are made.
struct LineImageNoise {
  double shot = 0.0, read = 0.0;
};
LineImageNoise noise_of(const LineImageLook& look);

/// The Cramér–Rao bound of the position of a spot that stands alone, averaged over its place in the pixel, px.
double lone_spot_bound_px(const LineImageLook& look);

/// The scene of the simulated figures as its detectors' pixels see it: lenses, and blinking or coloured markers.
struct LineImageScene {
  /// With lenses and exact readings; a frame is a row, and what is occluded is dark in it.
  BodySceneOptions scene;
  std::vector<LineDetector> detectors;  ///< LineCamera; those that are left out here record nothing
  std::vector<RigidBody> bodies;
  std::vector<MarkerSign> signs;  ///< of the bodies' markers
  std::vector<int> phases;        ///< which row of its code each marker shows in row 0, whatever `signs` says of it
  LineImageLook look;
};

/// `codes`: one per marker, in the order of ids; phases are drawn by scene.seed, and signs[i].phase is empty. Throws
/// std::invalid_argument where there are not as many codes as markers, where the scene is one of wrong ids or readings
/// spread in time, which rows of pixels are not, and as validate
/// does.
LineImageScene line_image_scene(BodySceneOptions scene, const std::vector<std::string>& codes,
                                const LineImageLook& look = {});

/// Successive rows.
struct LineImageBlock {
  int first_row = 0;
  std::vector<cv::Mat> images;         ///< of each detector: rows × width, 8 or 16 bits, one or three channels
  std::vector<BodySceneFrame> frames;  ///< of each row: where lit, visible markers are exactly, with sigma the bound
};

/// Draws what all detectors record, block by block; nothing is kept of what was given. The same scene gives the same
/// images.
class LineImageRecording {
 public:
  explicit LineImageRecording(const LineImageScene& scene);

  /// The next `rows` rows, fewer at the end, empty after it.
  std::optional<LineImageBlock> next(int rows);

 private:
  std::optional<BodySceneFrame> next_frame(int row);

  LineImageScene scene_;
  BodyScene frames_;
  int next_row_ = 0;
};

/// The frame with each reading moved by chance, as its sigma says.
BodySceneFrame disturbed(BodySceneFrame frame, std::mt19937_64& random);

}  // namespace alidade
