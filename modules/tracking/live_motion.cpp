// SPDX-License-Identifier: Apache-2.0
#include "tracking/live_motion.h"

#include <algorithm>

#include "tracking/motion_learning.h"

namespace alidade {
namespace {

constexpr std::size_t kLearnEvery = 30;  // frames
constexpr std::size_t kMemory = 150;
constexpr int kLearningSteps = 4;

}  // namespace

CameraState LiveMotion::predicted(Timestamp time) const {
  return model_ == MotionModel::Modes ? predict(state_, time, motion_) : predict(state_, time, noise_);
}

void LiveMotion::start(const StampedPose& first, const StampedPose& second, double frame_s) {
  CameraState state = moving_state(first, second);
  const double pair_s = std::max(1e-6, to_seconds(second.time - first.time));
  const double v = state.v_world.norm(), omega = std::max(state.omega_camera.norm(), 0.1 / pair_s);
  if (model_ == MotionModel::ConstantVelocity) {
    state = resting_state(second.time, second.T_world_camera, state.covariance.topLeftCorner<6, 6>(), v, omega);
    state.v_world = (second.T_world_camera.translation() - first.T_world_camera.translation()) / pair_s;
    state.omega_camera = difference(first.T_world_camera, second.T_world_camera).tail<3>() / pair_s;
  }
  // One frame's change of pace is not known yet; the pair's bounds it from above.
  noise_.acceleration = isotropic_noise(v / pair_s, std::max(omega, 0.05 / pair_s) / pair_s);
  motion_ = guessed_motion(v, omega, frame_s);
  restart(state);
}

void LiveMotion::follow(Timestamp time, const PoseUpdate& pose) {
  if (model_ == MotionModel::ConstantVelocity) {
    const CameraState next = absorb(predict(state_, time, noise_), pose.T_world_camera, pose.covariance);
    noise_ = adapt(noise_, state_, next, 0.1);
    state_ = next;
    return;
  }
  state_ = absorb(state_, time, motion_, pose.sightings).state;
  recent_.push_back({time, pose.sightings});
  if (recent_.size() % kLearnEvery == 0) learn();
}

void LiveMotion::jump(const StampedPose& pose) {
  if (model_ == MotionModel::Modes) return restart(moving_state({state_.time, state_.T_world_camera, {}}, pose));
  const CameraState next = absorb(predict(state_, pose.time, noise_), pose.T_world_camera, *pose.covariance);
  noise_ = adapt(noise_, state_, next, 0.5);
  state_ = next;
}

void LiveMotion::find_anew(const StampedPose& pose, double depth_m, double frame_s) {
  // A hand turns by a radian per second and crosses half the depth in one.
  const double v = 0.5 * depth_m, omega = 1.0;
  CameraState state = resting_state(pose.time, pose.T_world_camera, *pose.covariance, v, omega);
  noise_.acceleration = isotropic_noise(2.0 * depth_m, 10.0);
  if (model_ == MotionModel::Modes) state.covariance.block<6, 6>(12, 12) = noise_.acceleration;
  if (motion_.empty()) motion_ = guessed_motion(v, omega, frame_s);
  restart(state);
}

void LiveMotion::pass(Timestamp time) {
  state_ = predicted(time);
  if (model_ == MotionModel::Modes) recent_.push_back({time, {}});
}

void LiveMotion::correct(const Eigen::Isometry3d& T_world_camera) {
  state_.T_world_camera = T_world_camera;
}

void LiveMotion::restart(CameraState state) {
  first_ = state_ = std::move(state);
  recent_.clear();
}

void LiveMotion::learn() {
  const auto filter = [this](const MotionProcess& motion) {
    return std::vector<std::vector<MotionStep>>{filter_likelihoods(first_, recent_, motion)};
  };
  motion_ = learn_motion(std::move(motion_), kLearningSteps, filter);
  if (recent_.size() < 2 * kMemory) return;
  first_ = filter(motion_).front()[kMemory - 1].state;
  recent_.erase(recent_.begin(), recent_.begin() + kMemory);
}

}  // namespace alidade
