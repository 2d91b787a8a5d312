// SPDX-License-Identifier: Apache-2.0
#include "app/experiments/camera_runs.h"

#include <algorithm>
#include <limits>

#include <Eigen/LU>

#include "estimation/motion_learning.h"
#include "estimation/state_smoother.h"
#include "reconstruction/map_point.h"
#include "tracking/map_offset.h"
#include "tracking/paper_filter.h"

namespace alidade {
namespace {

constexpr double kFrameS = 1.0 / 30.0;
constexpr std::size_t kFirst = 2;  // the frame that the estimators begin with

struct Pace {
  double frame_s = 0.0;
  double v = 0.0, omega = 0.0;  // m/s, rad/s
};

Pace pace_of(const Trajectory& truth) {
  const Vector6d motion = difference(truth[0].T_world_camera, truth[1].T_world_camera);
  const double frame_s = to_seconds(truth[1].time - truth[0].time);
  return {frame_s, motion.head<3>().norm() / frame_s, motion.tail<3>().norm() / frame_s};
}

std::vector<PointObservation> with_sigma(std::vector<PointObservation> observations, double sigma_px) {
  for (PointObservation& o : observations) o.sigma_px = sigma_px;
  return observations;
}

StampedPose stamped(const MotionState& state) {
  return {state.time, state.T_world_body, Matrix6d(state.covariance.topLeftCorner<6, 6>())};
}

// The paper's model has none.
void forget_accelerations(MotionState& state) {
  state.covariance.bottomRows<6>().setZero();
  state.covariance.rightCols<6>().setZero();
}

// log p(z) of the paper's filter over a run, its sightings taken as Gaussian about the prediction (eqs. 8-13).
double paper_log_evidence(const Camera& camera, const CameraRun& run, const MotionNoise& noise, double sigma_px) {
  MotionState state = moving_state(run.truth[0], run.truth[1]);
  forget_accelerations(state);
  double sum = 0.0;
  for (std::size_t k = kFirst; k < run.truth.size(); ++k) {
    const MotionState predicted = predict(state, run.truth[k].time, noise);
    const std::vector<PointObservation> observations = with_sigma(run.sightings[k], sigma_px);
    PosePrior prior{predicted.T_world_body, predicted.covariance.topLeftCorner<6, 6>().inverse()};
    PoseUpdateOptions options;
    options.map_uncertainty = MapUncertainty::Ignored;
    const auto update = update_pose(camera, prior, observations, options);
    if (!update) return -std::numeric_limits<double>::infinity();
    sum += log_evidence(predicted, update->sightings);
    state = update_paper_filter(camera, predicted, observations);
    if (!state.covariance.allFinite()) return -std::numeric_limits<double>::infinity();
  }
  return sum;
}

// Each frame by itself; one without an answer keeps the pose before it.
template <typename Solve>
Trajectory estimate_each(const CameraRun& run, const Solve& solve) {
  Trajectory estimate;
  StampedPose last = run.truth[kFirst - 1];
  for (std::size_t k = kFirst; k < run.truth.size(); ++k) {
    if (const auto T = solve(run.sightings[k])) last.T_world_camera = *T;
    last.time = run.truth[k].time;
    estimate.push_back(last);
  }
  return estimate;
}

}  // namespace

CameraRun simulate_run(const CameraScene& scene, unsigned number) {
  std::mt19937_64 random(number);
  CameraRun run;
  run.number = number;
  for (const Eigen::Isometry3d& T : orbit_poses(scene.path, scene.frames)) {
    const auto frame = static_cast<double>(run.truth.size());
    run.truth.push_back({Timestamp(from_seconds(frame * kFrameS)), T, std::nullopt});
    auto sightings = sighted(scene.camera, T, scene.points, scene.sigma_px, random);
    run.sightings.push_back(with_outliers(scene.camera, std::move(sightings), scene.outliers, random));
  }
  return run;
}

std::vector<CameraRun> simulate_runs(const CameraScene& scene, unsigned first, int count) {
  std::vector<CameraRun> runs;
  for (int i = 0; i < count; ++i) runs.push_back(simulate_run(scene, first + static_cast<unsigned>(i)));
  return runs;
}

std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points, std::size_t count) {
  if (count >= points.size()) return points;
  std::vector<Eigen::Vector3d> fewer;
  for (std::size_t i = 0; i < count; ++i) fewer.push_back(points[i * points.size() / count]);
  return fewer;
}

CameraRun with_map_of_two_views(const Camera& camera, CameraRun run, double sigma_px) {
  const Eigen::Vector3d between =
      0.5 * (run.truth[0].T_world_camera.translation() + run.truth[1].T_world_camera.translation());
  MapPointOptions any;
  any.least_angle_deg = 0.0;
  any.gate_chi2 = std::numeric_limits<double>::infinity();
  std::vector<std::optional<Intersection>> points;
  for (std::size_t i = 0; i < run.sightings[0].size(); ++i) {
    std::vector<PosedSighting> views;
    for (std::size_t k : {0, 1}) {
      views.push_back({run.truth[k].T_world_camera, Matrix6d::Zero(), run.sightings[k][i].pixel, sigma_px});
    }
    points.push_back(triangulate(camera, views, any));
  }
  for (std::vector<PointObservation>& sightings : run.sightings) {
    std::vector<PointObservation> of_map;
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      if (!points[i]) continue;
      of_map.push_back(sightings[i]);
      of_map.back().p_world = points[i]->p_world;
      of_map.back().covariance_world = points[i]->covariance_world;
      of_map.back().seen_from = between;
    }
    sightings = std::move(of_map);
  }
  return run;
}

MotionProcess guessed_motion(const Trajectory& truth) {
  const Pace pace = pace_of(truth);
  return guessed_motion(pace.v, pace.omega, pace.frame_s);
}

Trajectory estimate_single_frames(const Camera& camera, const CameraRun& run, PnpMethod method) {
  return estimate_each(run, [&](const auto& sightings) { return solve_pnp(camera, sightings, method); });
}

Trajectory estimate_by_ransac(const Camera& camera, const CameraRun& run, double sigma_px) {
  return estimate_each(run, [&](const auto& sightings) { return solve_pnp_ransac_lm(camera, sightings, sigma_px); });
}

Trajectory estimate_by_paper_filter(const Camera& camera, const CameraRun& run, const MotionNoise& noise,
                                    double sigma_px) {
  Trajectory estimate;
  MotionState state = moving_state(run.truth[0], run.truth[1]);
  forget_accelerations(state);
  for (std::size_t k = kFirst; k < run.truth.size(); ++k) {
    state =
        update_paper_filter(camera, predict(state, run.truth[k].time, noise), with_sigma(run.sightings[k], sigma_px));
    estimate.push_back(stamped(state));
  }
  return estimate;
}

std::vector<MotionStep> filter_run(const Camera& camera, const CameraRun& run, const CameraFilterOptions& options,
                                   SharedMapError shared) {
  std::vector<MotionStep> steps;
  MotionState state = moving_state(run.truth[0], run.truth[1]);
  if (shared == SharedMapError::Considered) state.map_offset = rigid_offset(run.sightings[kFirst]);
  SightingNoise noise;
  for (std::size_t k = kFirst; k < run.truth.size(); ++k) {
    std::vector<PointObservation> apart;
    std::span<const PointObservation> sightings = run.sightings[k];
    if (shared == SharedMapError::Considered) sightings = apart = apart_from(state.map_offset, run.sightings[k]);
    auto step = filter_step(camera, state, noise, run.truth[k].time, sightings, options);
    if (step) noise = step->noise;
    steps.push_back(step ? std::move(step->motion) : pass(state, run.truth[k].time, options.motion));
    state = steps.back().state;
  }
  return steps;
}

Trajectory causal_poses(std::span<const MotionStep> steps) {
  Trajectory poses;
  for (const MotionStep& step : steps) poses.push_back(stamped(step.state));
  return poses;
}

Trajectory smoothed_poses(std::span<const MotionStep> steps, int lag) {
  Trajectory poses;
  for (const MotionState& state : smoothed_states(steps, lag)) poses.push_back(stamped(state));
  return poses;
}

MotionProcess learn_motion(const Camera& camera, std::span<const CameraRun> runs, const CameraFilterOptions& options,
                           SharedMapError shared) {
  constexpr int kMostSteps = 100;
  return learn_motion(options.motion, kMostSteps, [&](const MotionProcess& motion) {
    CameraFilterOptions with = options;
    with.motion = motion;
    std::vector<std::vector<MotionStep>> filtered;
    for (const CameraRun& run : runs) filtered.push_back(filter_run(camera, run, with, shared));
    return filtered;
  });
}

MotionNoise tune_paper_noise(const Camera& camera, std::span<const CameraRun> runs, double sigma_px) {
  const Pace pace = pace_of(runs.front().truth);
  MotionNoise best;
  double most = -std::numeric_limits<double>::infinity();
  for (double a : {0.01, 0.02, 0.04, 0.08, 0.16}) {
    for (double alpha : {0.01, 0.02, 0.04, 0.08, 0.16}) {
      MotionNoise noise;
      noise.acceleration = isotropic_noise(a * pace.v / pace.frame_s, alpha * pace.omega / pace.frame_s);
      double sum = 0.0;
      for (const CameraRun& run : runs) sum += paper_log_evidence(camera, run, noise, sigma_px);
      if (sum > most) {
        most = sum;
        best = noise;
      }
    }
  }
  return best;
}

}  // namespace alidade
