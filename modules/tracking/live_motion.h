// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "geometry/trajectory.h"
#include "tracking/motion_step.h"

namespace alidade {

/// Which motion a live camera is taken to have.
enum class MotionModel {
  Modes,             ///< constant acceleration with modes, whose noise is learned from the last seconds
  ConstantVelocity,  ///< the paper's, its noise adapted to the last steps
};

/// How a camera moves while it is followed frame by frame: its state, and what has been learned of the motion's noise.
class LiveMotion {
 public:
  explicit LiveMotion(MotionModel model) : model_(model) {}

  const CameraState& state() const { return state_; }

  /// Of constant velocity, as adapted to the last steps.
  const MotionNoise& velocity_noise() const { return noise_; }

  /// The state expected at `time`.
  CameraState predicted(Timestamp time) const;

  /// At the second of two poses that may be many frames apart; `frame_s`: seconds from frame to frame.
  void start(const StampedPose& first, const StampedPose& second, double frame_s);

  /// The frame's sightings were found where predicted() had them; `pose` is what they and the prediction give.
  void follow(Timestamp time, const PoseUpdate& pose);

  /// It has gone where the prediction did not have it.
  void jump(const StampedPose& pose);

  /// Found again after a while, with points at `depth_m`: its motion is unknown, as far as a hand can move it.
  void find_anew(const StampedPose& pose, double depth_m, double frame_s);

  /// Not measured at `time`.
  void pass(Timestamp time);

  /// The map has been adjusted, and the camera with it.
  void correct(const Eigen::Isometry3d& T_world_camera);

 private:
  void restart(CameraState state);
  void learn();

  MotionModel model_;
  CameraState state_;
  MotionProcess motion_;
  MotionNoise noise_;                    // of constant velocity
  CameraState first_;                    // before recent_
  std::vector<FrameLikelihood> recent_;  // to learn from
};

}  // namespace alidade
