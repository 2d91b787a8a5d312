// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "camera/camera.h"
#include "camera/measurement.h"
#include "datasets/object_orbit.h"
#include "geometry/trajectory.h"
#include "reconstruction/resection.h"
#include "tracking/camera_filter.h"

namespace alidade {

/// One recording of an experiment: a camera on its path, and what it sees in each frame.
struct CameraRun {
  unsigned number = 0;  ///< of simulate_run
  Trajectory truth;
  std::vector<std::vector<PointObservation>> sightings;  ///< one list per pose; sigma_px 1, whatever the noise is
};

/// What the estimators are compared in.
struct CameraScene {
  Camera camera = orbit_camera();
  std::vector<Eigen::Vector3d> points = orbit_object();
  OrbitPath path = OrbitPath::Smooth;
  int frames = 55;
  double sigma_px = 3.0;
  double outliers = 0.0;  ///< share of the sightings
};

/// The run of a scene with this number; another number, another noise.
CameraRun simulate_run(const CameraScene& scene, unsigned number);

/// `count` runs from `first` on.
std::vector<CameraRun> simulate_runs(const CameraScene& scene, unsigned first, int count);

/// `count` of the points, or all of them: every n-th.
std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points, std::size_t count);

/// A run whose map is not known but triangulated from the first two frames, at their true poses; the points carry their
/// covariance, and LM has no better ones.
CameraRun with_map_of_two_views(const Camera& camera, CameraRun run, double sigma_px);

/// A first guess of the motion's noise, from the first two poses: for learning to start from.
MotionProcess guessed_motion(const Trajectory& truth);

/// Poses of all frames from the third on. A frame without an answer keeps the pose before it.
Trajectory estimate_single_frames(const Camera& camera, const CameraRun& run, PnpMethod method);
/// The same by solve_pnp_ransac_lm.
Trajectory estimate_by_ransac(const Camera& camera, const CameraRun& run, double sigma_px);
Trajectory estimate_by_paper_filter(const Camera& camera, const CameraRun& run, const MotionNoise& noise,
                                    double sigma_px);

/// What the filter makes of the error that all sightings of an uncertain map share.
enum class SharedMapError { Ignored, Considered };
std::vector<MotionStep> filter_run(const Camera& camera, const CameraRun& run, const CameraFilterOptions& options,
                                   SharedMapError shared = SharedMapError::Ignored);

Trajectory causal_poses(std::span<const MotionStep> steps);
/// `lag`: see smoothed_states.
Trajectory smoothed_poses(std::span<const MotionStep> steps, int lag);

/// Our filter's motion noise by innovation likelihood (expectation maximisation) on runs that are not scored.
MotionProcess learn_motion(const Camera& camera, std::span<const CameraRun> runs, const CameraFilterOptions& options,
                           SharedMapError shared = SharedMapError::Ignored);

/// The paper filter's two noises by innovation likelihood on runs that are not scored.
MotionNoise tune_paper_noise(const Camera& camera, std::span<const CameraRun> runs, double sigma_px);

}  // namespace alidade
