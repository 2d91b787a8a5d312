// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/body_recording.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "marker1d/body_smoother.h"
#include "marker1d/body_tracker.h"
#include "marker1d/paper_tracker.h"

namespace alidade {
namespace {

constexpr double kLag_s = 0.5;
constexpr double kWorstBound_m = 0.01;  // beyond it a frame by itself says next to nothing

std::optional<StampedPose> answer_of(const BodyEstimate& e) {
  if (e.status != BodyStatus::Tracked) return std::nullopt;
  return StampedPose{e.time, e.state.T_world_body, Matrix6d(e.state.covariance.topLeftCorner<6, 6>())};
}

std::optional<StampedPose> answer_of(const PaperStep& step) {
  if (step.outcome == PaperOutcome::Lost || step.is_degenerate) return std::nullopt;
  return StampedPose{step.time, step.T_world_body, std::nullopt};
}

}  // namespace

BodyRecording recording_of(std::vector<LineDetector> detectors, RigidBody body, std::vector<BodySceneFrame> frames) {
  BodyRecording recording{std::move(detectors), std::move(body), std::move(frames), {}};
  for (const BodySceneFrame& frame : recording.frames) {
    const Eigen::Isometry3d T = pose_in_scene(0, frame.time);
    auto bound = pose_bound(pose_information(recording.detectors, recording.body, T, right_readings(frame)));
    if (bound && bound->position_m2 > kWorstBound_m * kWorstBound_m) bound.reset();
    recording.bounds.push_back(bound);
  }
  return recording;
}

BodyRecording record_body(const BodySceneOptions& options) {
  BodyScene scene(options);
  std::vector<BodySceneFrame> frames;
  while (auto frame = scene.next()) frames.push_back(std::move(*frame));
  return recording_of(scene.detectors(), scene.bodies().front(), std::move(frames));
}

PaperAnswers track_by_paper(const BodyRecording& recording) {
  PaperTracker tracker(recording.body);
  std::vector<PaperFrame> frames;
  std::vector<PaperStep> steps;
  for (const BodySceneFrame& frame : recording.frames) {
    frames.push_back({frame.time, marker_planes(recording.detectors, recording.body, frame.readings,
                                                tracker.predicted(frame.time))});
    steps.push_back(tracker.step(frame.time, frames.back().planes));
  }
  PaperAnswers answers;
  for (const PaperStep& step : steps) answers.forward.push_back(answer_of(step));
  for (const PaperStep& step : refine_backward(recording.body, frames, steps)) {
    answers.backward.push_back(answer_of(step));
  }
  return answers;
}

OurAnswers track_by_ours(const BodyRecording& recording) {
  const DetectorArray detectors(recording.detectors);
  BodyTracker tracker(detectors, recording.body);
  const double step_s = to_seconds(recording.frames.at(1).time - recording.frames.at(0).time);
  BodySmoother smoother(static_cast<int>(std::lround(kLag_s / step_s)));
  OurAnswers answers;
  const auto take = [&](const std::vector<BodyEstimate>& settled) {
    for (const BodyEstimate& e : settled) answers.smoothed.push_back(answer_of(e));
  };
  for (const BodySceneFrame& frame : recording.frames) {
    BodyEstimate estimate = tracker.track(frame.time, frame.readings);
    answers.forward.push_back(answer_of(estimate));
    take(smoother.add(std::move(estimate)));
  }
  take(smoother.finish());
  return answers;
}

BodyScore score_of(const BodyRecording& recording, const BodyAnswers& answers) {
  BodyScore score;
  double m2 = 0, rad2 = 0, nees = 0, bounded_m2 = 0, bounded_rad2 = 0, bound_m2 = 0, bound_rad2 = 0;
  int answered = 0, with_covariance = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!answers[i]) continue;
    const Vector6d error = difference(answers[i]->T_world_camera, pose_in_scene(0, answers[i]->time));
    ++answered;
    m2 += error.head<3>().squaredNorm();
    rad2 += error.tail<3>().squaredNorm();
    score.worst_m = std::max(score.worst_m, error.head<3>().norm());
    if (answers[i]->covariance) {
      ++with_covariance;
      nees += error.dot(answers[i]->covariance->llt().solve(error)) / 6.0;
    }
    const auto& bound = recording.bounds[i];
    if (!bound) continue;
    bounded_m2 += error.head<3>().squaredNorm();
    bounded_rad2 += error.tail<3>().squaredNorm();
    bound_m2 += bound->position_m2;
    bound_rad2 += bound->rotation_rad2;
  }
  score.answered_share = answered / static_cast<double>(recording.frames.size());
  score.rms_m = std::sqrt(m2 / answered);
  score.rms_rad = std::sqrt(rad2 / answered);
  score.position_to_bound = std::sqrt(bounded_m2 / bound_m2);
  score.rotation_to_bound = std::sqrt(bounded_rad2 / bound_rad2);
  if (with_covariance > 0) score.nees_per_dof = nees / with_covariance;
  return score;
}

}  // namespace alidade
