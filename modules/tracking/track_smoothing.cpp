// SPDX-License-Identifier: Apache-2.0
#include "tracking/track_smoothing.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/median.h"
#include "estimation/state_smoother.h"
#include "tracking/recording_noise.h"

namespace alidade {
namespace {

constexpr std::size_t kFewestFrames = 12;  // from which a motion's noise can be learned
constexpr int kLearningSteps = 20;

using Reports = std::span<FrameReport>;

// Runs of frames with poses, without a gap.
std::vector<Reports> segments(std::vector<FrameReport>& reports, double longest_gap_s) {
  std::vector<Reports> result;
  for (std::size_t begin = 0; begin < reports.size();) {
    std::size_t end = begin;
    const auto continues = [&] {
      if (end == reports.size() || !reports[end].has_pose()) return false;
      if (end == begin) return true;
      const double dt = to_seconds(reports[end].time - reports[end - 1].time);
      return dt > 0 && dt < longest_gap_s;
    };
    while (continues()) ++end;
    if (end - begin >= kFewestFrames) result.push_back(Reports(reports).subspan(begin, end - begin));
    begin = std::max(end, begin + 1);
  }
  return result;
}

// A segment as the filter takes it: the state at its first frame, before its sightings are seen.
struct Recording {
  MotionState first;
  std::vector<FrameLikelihood> frames;
  double v = 0.0, omega = 0.0;  // median pace, m/s and rad/s
  double dt = 0.0;              // median
};

Recording recording_of(Reports segment) {
  Recording recording;
  std::vector<double> v, omega, dt;
  for (std::size_t i = 0; i < segment.size(); ++i) {
    recording.frames.push_back({segment[i].time, segment[i].likelihood});
    if (i == 0) continue;
    const Vector6d motion = difference(segment[i - 1].T_world_camera, segment[i].T_world_camera);
    dt.push_back(to_seconds(segment[i].time - segment[i - 1].time));
    v.push_back(motion.head<3>().norm() / dt.back());
    omega.push_back(motion.tail<3>().norm() / dt.back());
  }
  recording.dt = median(dt);
  recording.v = median(v);
  recording.omega = median(omega);
  // All but known: what is said of the first frame is said by its sightings, and by those after it.
  const double v_max = *std::max_element(v.begin(), v.end()), omega_max = *std::max_element(omega.begin(), omega.end());
  Matrix6d wide = Matrix6d::Zero();
  wide.topLeftCorner<3, 3>() = std::pow(10.0 * v_max * recording.dt, 2) * Eigen::Matrix3d::Identity();
  wide.bottomRightCorner<3, 3>() = std::pow(10.0 * omega_max * recording.dt, 2) * Eigen::Matrix3d::Identity();
  recording.first = resting_state(segment.front().time, segment.front().T_world_camera, wide, v_max, omega_max);
  recording.first.covariance.block<6, 6>(12, 12) = isotropic_noise(v_max / recording.dt, omega_max / recording.dt);
  return recording;
}

void smooth(Reports segment, const TrackSmoothingOptions& options) {
  const Recording recording = recording_of(segment);
  RecordingNoise noise{guessed_motion(recording.v, recording.omega, recording.dt)};
  noise = learned(std::move(noise), recording.first, recording.frames, kLearningSteps);
  const std::vector<MotionStep> steps = filter_recording(recording.first, recording.frames, noise);
  const std::vector<MotionState> states = smoothed_states(steps, options.lag);
  for (std::size_t i = 0; i < segment.size(); ++i) {
    if (segment[i].is_keyframe) continue;
    segment[i].T_world_camera = states[i].T_world_body;
    segment[i].covariance = states[i].covariance.topLeftCorner<6, 6>();
  }
}

}  // namespace

std::vector<FrameReport> smoothed(std::vector<FrameReport> reports, const TrackSmoothingOptions& options) {
  for (Reports segment : segments(reports, options.longest_gap_s)) smooth(segment, options);
  return reports;
}

}  // namespace alidade
