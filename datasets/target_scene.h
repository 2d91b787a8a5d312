// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "camera/measurement.h"
#include "camera/receiver.h"
#include "core/time.h"

namespace alidade {

/// Where the times come from at which receivers see a target.
enum class ScanLaw {
  Delays,    ///< receiver k sees everything delays_s[k] after the period's begin
  Rotating,  ///< receiver k's fan beam turns about the vertical once a period: a target is seen as it passes
  Cued,      ///< the first receiver sees all at once; the others are steered from target to target, which takes time
};

/// Options of the scene of the simulated figures: objects that fly together, receivers around them.
struct TargetSceneOptions {
  int receivers = 3;  ///< evenly around the targets, all looking up at `elevation_rad`; 2 stand at right angles
  int targets = 2;
  int periods = 5;
  double period_s = 1.0;
  double least_range_m = 100.0;     ///< of the receivers' distance from the targets' middle, drawn once for all
  double greatest_range_m = 200.0;  ///< "
  double elevation_rad = 0.6155;    ///< atan(1/√2): the lines of sight of three receivers are then orthogonal
  ScanLaw scan_law = ScanLaw::Delays;
  std::vector<double> delays_s{0.0, 0.1, 0.2};  ///< of receivers 0, 1, ...; repeated where there are more
  double slew_rad_s = 1.0;                      ///< how fast cued receivers turn
  double sigma_m = 0.1;                         ///< bearings err by sigma_m / range across the line of sight, rad
  double spread_m = 15.0;                       ///< the targets' first positions lie within a cube of this side
  double least_distance_m = 3.0;                ///< between any two of them
  /// If given, they start in a row across the first receiver's view instead of in the cube, so far from each other.
  std::optional<double> row_spacing_m{};
  double velocity_sigma_m_s = 15.6;  ///< of each coordinate of their common velocity
  double top_speed_m_s = 60.0;       ///< faster ones are drawn again
  double scatter_m_s = 1.0;          ///< of each coordinate of each one's velocity beside the common one
  double acceleration_m_s2 = 0.0;    ///< of each coordinate of each one's constant acceleration
  double agility_m2_s3 = 0.0;        ///< spectral density of a white acceleration, alike along all axes, beside it
  double detection_probability = 1.0;
  double false_bearings = 0.0;  ///< mean of their (Poisson) number per receiver and period
  /// Full angle of the cone about the targets' middle in which they lie evenly: 20°.
  double cone_rad = 0.349066;
  /// What all receivers but the first read of a target's temperature errs by so much; 0: they read none.
  double temperature_sigma_k = 0.0;
  /// Temperatures of targets and of what is none lie evenly in a span about the first.
  double temperature_k = 290.0, temperature_span_k = 100.0;
  /// Every second target appears after a fifth of the time, or leaves a fifth before its end.
  bool comes_and_goes = false;
  unsigned seed = 1;
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const TargetSceneOptions& options);

/// How far gusts have carried a target off, and how much faster.
struct GustEffect {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero(), v_m_s = Eigen::Vector3d::Zero();
};

constexpr double kGustStep_s = 0.01;  ///< from one change of velocity to the next: finer than any look's time matters

/// The true path of a target: p0 + v t + a t² / 2, t from `origin`, and what gusts add.
struct TargetPath {
  int target = 0;  ///< 0, 1, ...
  Timestamp origin{}, birth{}, death{};
  Eigen::Vector3d p0_world, v_world, a_world;
  double temperature_k = 290.0;
  std::vector<GustEffect>
      gusts{};  ///< every kGustStep_s from `origin`; after the last one, and without any: straight on
};

/// Where the target of a path is (m), and how fast (m/s); at any time.
Eigen::Vector3d position_at(const TargetPath& path, Timestamp time);
Eigen::Vector3d velocity_at(const TargetPath& path, Timestamp time);

/// Receivers, what is true, and what was read.
struct TargetScene {
  std::vector<Receiver> receivers;  ///< direction finders that face the targets' middle; world z is up
  std::vector<TargetPath> paths;
  std::vector<ReceiverReading> readings;  ///< in order of time; each names its target, false ones −1
  double range_m = 0.0;                   ///< of the receivers, as drawn
};

/// The scene of the paper's tables: N = 5 periods, parallel paths 3 m apart, everything seen and nothing else. Which
/// way they lie apart, and when the lines of sight are orthogonal, the page leaves open: across the first receiver's
/// view (its x axis) and in the middle of the time come nearest to its re-created figures.
/// Source: UAV paper page, "Their experiment" and "Settings that reproduce it".
TargetSceneOptions paper_table_scene(int targets, const std::vector<double>& delays_s, unsigned seed);

/// Period `i` of the scene begins at i · period_s. The same options give the same scene.
/// Source: UAV paper page, "Their experiment" and "Settings that reproduce it".
TargetScene make_target_scene(const TargetSceneOptions& options);

}  // namespace alidade
