// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "camera/line_detector.h"
#include "camera/measurement.h"
#include "core/time.h"
#include "geometry/pose.h"
#include "geometry/rigid_body.h"

namespace alidade {

/// Options of the scene of the simulated figures: blocks of four linear detectors about moving bodies.
struct BodySceneOptions {
  int frames = 10000;
  double rate_hz = 250.0;   ///< frames per second; the paper has 200 to 300
  int markers = 4;          ///< of each body: 3 (a bent triangle), 4 (a tetrahedron) or 8 (a cube)
  int blocks = 3;           ///< of four detectors, each a station
  int bodies = 1;           ///< all alike but for the disturbance of their corners
  double sigma_rad = 1e-4;  ///< of a reading, about the focal line; 0: exact, and told to be of LineDetector's default
  bool has_lenses = false;  ///< detectors are lines of 2048 px behind lenses of 64° with some distortion
  double sigma_px = 0.1;    ///< of a reading by them; 0: exact, and told to be of 0.5 px
  double wrong_ids = 0.0;   ///< share of readings that are named after another marker of the same body
  double occluded = 0.0;    ///< probability that a block does not see a marker, once drawn; 0.6 on the paper's page
  double redrawn = 0.03;    ///< probability per frame that it is drawn anew: bursts of 1 / redrawn frames
  double skew_s = 0.0;      ///< the readings of a frame are spread over this time after the frame's
  unsigned seed = 1;        ///< of the bodies' corners and of all chance
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const BodySceneOptions& options);

/// What all detectors read between one frame's time and the next, in order of time.
struct BodySceneFrame {
  Timestamp time{};
  std::vector<LineReading> readings;
  std::vector<bool> is_right;  ///< one per reading: it is of the marker that it names
};

/// The readings of a frame that are of the markers that they name.
std::vector<LineReading> right_readings(const BodySceneFrame& frame);

/// The readings of bodies on smooth paths by detectors about them, frame by frame, with exact truth; nothing is kept of
/// a frame that was given. The same options give the same readings. Detectors are focal lines, or line cameras; the
/// world's z is up.
/// Source: marker1d paper page, "The scene of the simulated figures".
class BodyScene {
 public:
  /// Throws std::invalid_argument as validate does.
  explicit BodyScene(const BodySceneOptions& options);

  /// Four of each block, with ids 0, 1, ... in the order of blocks; a block is a station named block1, block2, ...
  const std::vector<LineDetector>& detectors() const { return detectors_; }

  /// With marker ids 0, 1, ... through all bodies; named body1, body2, ...
  const std::vector<RigidBody>& bodies() const { return bodies_; }

  /// i / rate from 0, in ns.
  Timestamp time(int frame) const;

  /// The next frame, from frame 0; empty after the last one.
  std::optional<BodySceneFrame> next();

 private:
  struct Chance {
    std::mt19937_64 noise, names, occlusion;
  };

  void redraw_occlusion();
  void read_body(int body, BodySceneFrame& frame);
  int name_of(int body, int marker);

  BodySceneOptions options_;
  Chance chance_;
  std::vector<RigidBody> bodies_;
  std::vector<LineDetector> detectors_;
  std::vector<bool> hidden_;  // block after block, one per marker of all bodies
  int next_frame_ = 0;
};

/// Where body `index` (0, 1, ...) of the scene is at `time`, T_world_body; any time.
Eigen::Isometry3d pose_in_scene(int index, Timestamp time);

/// How it moves: m/s and rad/s along its own axes.
Vector6d twist_in_scene(int index, Timestamp time);

}  // namespace alidade
