// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "calib/detectors/body_motion.h"
#include "camera/line_detector.h"

namespace alidade {

/// A reading whose detector and marker are known by place, not by id.
struct PlacedReading {
  std::size_t detector = 0;  ///< index into the detectors
  std::size_t marker = 0;    ///< index into the marker positions
  double time_s = 0.0;
  double value = 0.0;
  double sigma = 0.0;
};

/// What readings are explained with: detectors and the body's markers.
struct DetectorScene {
  std::vector<LineDetector> detectors;
  std::vector<Eigen::Vector3d> markers;  ///< p_body, m
};

/// A pose of the body that explains the readings of a short while, taken as of one moment.
struct RoughPose {
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  double median_sigmas = 0.0;  ///< of the readings' absolute residuals
};

/// The pose nearest to `guess` in which the readings are explained best, by robust Gauss–Newton steps; the guess itself
/// counts with `prior_m` and `prior_rad`. Empty where no reading can be taken there.
std::optional<RoughPose> refine_pose(const DetectorScene& scene, std::span<const PlacedReading> readings,
                                     const Eigen::Isometry3d& guess, double prior_m, double prior_rad);

/// The same without a guess: from where the planes of all readings meet, and from 24 attitudes.
std::optional<RoughPose> find_pose(const DetectorScene& scene, std::span<const PlacedReading> readings);

/// Knots at `times_s`, each from the readings within `window_s` of it and the knot before.
/// Empty where the first pose is not found, and once a stop is requested.
std::optional<std::vector<MotionKnot>> start_motion(const DetectorScene& scene, std::span<const PlacedReading> readings,
                                                    std::span<const double> times_s, double window_s,
                                                    const std::stop_token& stop = {});

}  // namespace alidade
