// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "calib/receivers/known_track.h"

namespace alidade {

/// The weights of the four control points between two knots, at `u` of the way from one to the other, and their
/// derivatives by u. Uniform cubic B-spline; beyond [0, 1] the polynomial goes on.
Eigen::Vector4d spline_weights(double u);
Eigen::Vector4d spline_slopes(double u);

/// A path as a uniform cubic B-spline: smooth up to the acceleration. Control points i to i + 3 tell the path from
/// begin_s + i · interval_s to the next knot.
struct SplinePath {
  double begin_s = 0.0;
  double interval_s = 0.4;
  std::vector<Eigen::Vector3d> control_m;

  double end_s() const { return begin_s + interval_s * (static_cast<double>(control_m.size()) - 3.0); }
  /// The interval in which a time lies, the first or the last for times outside.
  int interval_at(double t_s) const;
  /// Empty outside [begin_s, end_s].
  std::optional<TrackPoint> at(double t_s) const;
};

/// The spline nearest to a path known at its knots: `p_at_knots[k]` at begin_s + (k − 1) · interval_s.
SplinePath spline_through(double begin_s, double interval_s, std::vector<Eigen::Vector3d> p_at_knots);

}  // namespace alidade
