// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib/receivers/receiver_parameters.h"
#include "calib/receivers/spline_path.h"

namespace alidade {

struct SplineBundleOptions {
  double knot_interval_s = 0.4;  ///< a multicopter turns no sharper than such a spline follows
  double readings_per_s = 10.0;  ///< of each receiver; the others are passed over: neighbours err alike
  double jerk_m_s3 = 20.0;       ///< standard deviation of each coordinate: what leads the path where nobody looks
  double place_sigma_m = 1.0;    ///< how far the receivers' places may be off, each coordinate; these and the next
  double turn_sigma_rad = 0.01;  ///< ones also hold what no reading tells: where, how large and when all is
  double offset_sigma_s = 0.1;
  double rate_sigma = 1e-4;
  double readout_sigma_s = 0.0;  ///< 0: it stands
  double focal_sigma = 0.02;     ///< of the focal lengths' logarithm; 0: they stand. Video modes crop and stretch
  /// Id of the receiver whose clock stands and is the common one; empty: the first. A path flown a little later looks
  /// the same to all.
  std::optional<int> time_receiver{};
  double loss_sigmas = 2.0;  ///< readings farther off count less (Cauchy), in units of their receiver's scatter
  int rounds = 4;            ///< of new scatters and knots; the last one changes next to nothing
};

/// Throws std::invalid_argument naming field, value and bound.
void validate(const SplineBundleOptions& options);

/// A flight and the cameras that watched it, as they explain each other.
struct SplineBundle {
  std::vector<Receiver> receivers;  ///< in the order given; sigma is the scatter of a coordinate, no less than given
  std::vector<ReceiverChange> changes;  ///< from the given ones
  SplinePath path;
  int iterations = 0;  ///< of the solver, in all
};

/// Path, poses, clocks (and as options say rolling shutters and focal lengths) of cameras that watched one target,
/// without truth: one robust least-squares problem with the path as a spline. It starts from the given receivers, which
/// may be off by about their sigmas; what all readings leave open (a similarity) stays where the given receivers
/// have it, as near as their sigmas say. Empty where the lines of sight of no two receivers meet.
/// Throws std::invalid_argument for fewer than two receivers, one without a camera, or readings of none of them.
/// Source: UAV paper page, "Where we go past it", 4; Li et al., Reconstruction of 3D flight trajectories from ad-hoc
/// camera networks, IROS 2020, for the spline.
std::optional<SplineBundle> bundle_flight(std::span<const Receiver> receivers,
                                          std::span<const ReceiverReading> readings,
                                          const SplineBundleOptions& options = {});

}  // namespace alidade
