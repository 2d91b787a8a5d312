// SPDX-License-Identifier: Apache-2.0
#include "tracking/live_motion.h"

#include <algorithm>
#include <cmath>

namespace alidade {
namespace {

constexpr std::size_t kLearnEvery = 5;  // frames: a step of it takes some milliseconds
constexpr std::size_t kMemory = 100;
constexpr int kLearningSteps = 2;

// A hand turns by a radian per second and crosses half the depth in one.
constexpr double kHandDepths = 0.5, kHandTurn = 1.0;

bool is_finite(const RecordingNoise& noise) {
  const auto is_sound = [](const MotionMode& mode) {
    return std::isfinite(mode.weight) && mode.noise.jerk.allFinite() && mode.noise.jump.allFinite();
  };
  return noise.pose.allFinite() && std::all_of(noise.motion.begin(), noise.motion.end(), is_sound);
}

}  // namespace

void LiveMotion::start(const StampedPose& first, const StampedPose& second, double frame_s) {
  const MotionState moving = moving_state(first, second);
  const double pair_s = std::max(1e-6, to_seconds(second.time - first.time));
  const double v = moving.v_world.norm(), omega = std::max(moving.omega_body.norm(), 0.1 / pair_s);
  state_ = resting_state(second.time, second.T_world_camera, moving.covariance.topLeftCorner<6, 6>(), v, omega);
  state_.v_world = moving.v_world;
  state_.omega_body = moving.omega_body;
  // One frame's change of pace is not known yet; the pair's is an upper bound, so that adapt() corrects it.
  noise_.acceleration = isotropic_noise(v / pair_s, std::max(moving.omega_body.norm(), 0.05 / pair_s) / pair_s);
  learned_ = {guessed_motion(v, omega, frame_s)};
  restart(moving);
}

void LiveMotion::follow(Timestamp time, const PoseUpdate& pose) {
  const MotionState next = absorb(predicted(time), pose.T_world_camera, pose.covariance);
  noise_ = adapt(noise_, state_, next, 0.1);
  state_ = next;
  if (learned_.pose.isZero(0.0)) learned_.pose = guessed_pose_noise(pose.sightings);
  estimate_ = absorb(estimate_, time, learned_.motion, blurred(pose.sightings, learned_.pose)).state;
  recent_.push_back({time, pose.sightings});
  if (recent_.size() % kLearnEvery == 0) learn();
}

void LiveMotion::jump(Timestamp time, const PoseUpdate& pose, double depth_m, double frame_s) {
  const MotionState next = absorb(predicted(time), pose.T_world_camera, pose.covariance);
  const MotionNoise open = adapt(noise_, state_, next, 0.5);
  find_anew(time, pose, depth_m, frame_s);
  state_ = next;
  noise_ = open;
}

void LiveMotion::find_anew(Timestamp time, const PoseUpdate& pose, double depth_m, double frame_s) {
  const double v = kHandDepths * depth_m;
  state_ = resting_state(time, pose.T_world_camera, pose.covariance, v, kHandTurn);
  noise_.acceleration = isotropic_noise(2.0 * depth_m, 10.0);
  if (learned_.motion.empty()) learned_.motion = guessed_motion(v, kHandTurn, frame_s);
  MotionState estimate = resting_state(time, pose.T_world_camera, pose.covariance + learned_.pose, v, kHandTurn);
  estimate.covariance.block<6, 6>(12, 12) = noise_.acceleration;
  restart(std::move(estimate));
}

void LiveMotion::pass(Timestamp time) {
  state_ = predicted(time);
  estimate_ = ::alidade::pass(estimate_, time, learned_.motion).state;
  recent_.push_back({time, {}});
}

void LiveMotion::correct(const Eigen::Isometry3d& T_world_camera) {
  state_.T_world_body = estimate_.T_world_body = T_world_camera;
}

void LiveMotion::restart(MotionState estimate) {
  first_ = estimate_ = std::move(estimate);
  recent_.clear();
}

void LiveMotion::learn() {
  RecordingNoise better = learned(learned_, first_, recent_, kLearningSteps);
  if (is_finite(better)) learned_ = std::move(better);  // else what was known before stays
  if (recent_.size() < 2 * kMemory) return;
  first_ = filter_recording(first_, recent_, learned_)[kMemory - 1].state;
  recent_.erase(recent_.begin(), recent_.begin() + kMemory);
}

}  // namespace alidade
