// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "calib/detectors/motion_start.h"
#include "camera/measurement.h"
#include "geometry/rigid_body.h"
#include "geometry/trajectory.h"

namespace alidade {

/// How a body moves about one moment: with constant accelerations.
struct WindowMotion {
  double time_s = 0.0;
  MotionKnot knot;                                       ///< at that moment
  Eigen::Vector3d a_world = Eigen::Vector3d::Zero();     ///< m/s²
  Eigen::Vector3d alpha_body = Eigen::Vector3d::Zero();  ///< rad/s², along its own axes
};

/// The pose `tau_s` after the moment: p + v τ + a τ²/2, R exp(ω τ + α τ²/2).
Eigen::Isometry3d pose_after(const WindowMotion& motion, double tau_s);

/// The motion that explains the readings of one short window best, from these readings alone: `start` only says where
/// the search begins. `parameters`: 6 (a pose; `start`'s velocities stand), 12 (velocities too), 18 (accelerations
/// too). Robust (Geman–McClure, tightened to `loss_sigmas`). Empty where no reading can be taken at the start. Throws
/// std::invalid_argument for another number of parameters.
std::optional<WindowMotion> fit_window(const DetectorScene& scene, std::span<const PlacedReading> readings,
                                       const WindowMotion& start, int parameters, double loss_sigmas);

struct WindowFitOptions {
  double window_s = 0.02;         ///< long enough for some readings of each station, short enough for 18 parameters
  int least_readings = 8;         ///< a window with fewer is passed over
  double explained_sigmas = 4.0;  ///< a reading nearer than that to the fit is explained
  double explained_share = 0.9;   ///< a window with more than this share of its readings explained is, too
};

/// Throws std::invalid_argument naming the field, its value and its bound.
void validate(const WindowFitOptions& options);

/// How well rigid motion explains a recording, window by window, none knowing of another.
struct WindowStatistics {
  int windows = 0;                   ///< of enough readings
  int explained = 0;                 ///< of these
  int largest_fit = 0;               ///< most parameters that a window had
  double median_sigmas = 0.0;        ///< of the absolute residuals of all their readings
  std::optional<double> median_rad;  ///< the same of those that are angles

  double explained_share() const { return windows > 0 ? static_cast<double>(explained) / windows : 0.0; }
};

/// Fits each window by itself, with the largest of 6, 12 and 18 parameters that it has twice as many readings of (6 at
/// least). Searches start at `motion` where it has a pose, else where the window's planes meet. Readings in order of
/// time; those of unknown detectors and markers are passed over. After a stop: of the windows so far.
WindowStatistics fit_windows(std::span<const LineDetector> detectors, const RigidBody& body,
                             std::span<const LineReading> readings, const Trajectory& motion,
                             const WindowFitOptions& options = {}, const std::stop_token& stop = {});

}  // namespace alidade
