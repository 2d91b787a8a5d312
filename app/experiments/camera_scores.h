// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/experiments/camera_runs.h"
#include "evaluation/ensemble.h"

namespace alidade {

/// Errors of one estimator over all runs of an experiment.
struct MethodErrors {
  std::string name;
  std::vector<std::vector<double>> position_m;    ///< by run and frame
  std::vector<std::vector<double>> rotation_rad;  ///< by run and frame
  std::vector<double> nees_per_dof;               ///< mean of each run; empty for a method without covariances
  std::vector<double> seconds;                    ///< CPU time of each run, all frames; empty where it was not taken
};

/// Adds one run of a method to its errors; the estimate begins at the third pose of the truth.
void add_run(MethodErrors& errors, const CameraRun& run, const Trajectory& estimate);

/// The errors over all runs, in the same frame.
std::vector<double> mean_by_frame(const std::vector<std::vector<double>>& errors);
std::vector<double> rms_by_frame(const std::vector<std::vector<double>>& errors);

/// Root mean square over all frames and runs.
double rms(const std::vector<std::vector<double>>& errors);

/// Root mean square over that of another method in the same runs, with its interval.
Ratio rms_ratio(const std::vector<std::vector<double>>& errors, const std::vector<std::vector<double>>& reference);

/// Share of the frames, position and rotation counted each, whose error (mean over the runs) is at most the
/// reference's, in percent.
double frames_not_worse_percent(const MethodErrors& errors, const MethodErrors& reference);

/// The greatest ratio of a frame's root mean square errors, of position and rotation.
double worst_frame_ratio(const MethodErrors& errors, const MethodErrors& reference);

double mean(const std::vector<double>& values);

/// The least root mean square position and rotation errors (m, rad) that any unbiased estimator of single frames can
/// have, by frame from the third on: the Cramér–Rao bound at the truth.
struct FrameBounds {
  std::vector<double> position_m, rotation_rad;
};
FrameBounds single_frame_bounds(const CameraScene& scene);

}  // namespace alidade
