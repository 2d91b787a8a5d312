// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tracking/recording_noise.h"

namespace alidade {

/// How a camera moves while it is followed frame by frame. Two beliefs: one to find its way by, loose and quick to
/// follow, that each frame's pose overrides; and the estimate, which weighs each frame against the motion by the noise
/// that both have shown.
class LiveMotion {
 public:
  /// At the last frame: constant velocity, its noise adapted to the last steps.
  const MotionState& state() const { return state_; }
  const MotionNoise& noise() const { return noise_; }

  /// At the last frame, by motion_step.h; its noise learned from the last seconds.
  const MotionState& estimate() const { return estimate_; }

  /// The state expected at `time`.
  MotionState predicted(Timestamp time) const { return predict(state_, time, noise_); }

  /// At the second of two poses that may be many frames apart; `frame_s`: seconds from frame to frame.
  void start(const StampedPose& first, const StampedPose& second, double frame_s);

  /// The frame's sightings were found where predicted() had them; `pose` is what they and the prediction give.
  void follow(Timestamp time, const PoseUpdate& pose);

  /// It was found where the prediction did not have it, with points at `depth_m`.
  void jump(Timestamp time, const PoseUpdate& pose, double depth_m, double frame_s);

  /// It was found again after a while: its motion is unknown, as far as a hand can move it.
  void find_anew(Timestamp time, const PoseUpdate& pose, double depth_m, double frame_s);

  /// Not measured at `time`.
  void pass(Timestamp time);

  /// The map has been adjusted, and the camera with it.
  void correct(const Eigen::Isometry3d& T_world_camera);

 private:
  void restart(MotionState estimate);
  void learn();

  MotionState state_;
  MotionNoise noise_;
  MotionState estimate_;
  RecordingNoise learned_;
  MotionState first_;                    // the estimate before recent_
  std::vector<FrameLikelihood> recent_;  // to learn from
};

}  // namespace alidade
