// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "camera/line_detector.h"

// The laser sweeps among the models of line_detector.h: raw angle of a point in the station's frame, rad, with its
// exact Jacobian. Empty behind the station (or beyond ±90° of its axis) and so far up or down that no sweep passes.
namespace alidade {

/// raw = ax − [asin(z tan(tilt) / √(x² + y²)) + phase − gibmag sin(ax + gibphase) + curve ay²], ax = atan2(y, x),
/// ay = atan2(z, x); for sweep 1 with (z, −y) in place of (y, z).
/// Source: libsurvive's and Bitcraze's first-generation model, as written in the README of the data set marker1d.
std::optional<LineProjection> project_sweep(const Lighthouse1& model, const Eigen::Vector3d& p_station);

/// raw = ax + asin(z tan(∓30° − tilt) / √(x² + y²)) − phase + gibmag cos(ax + gibphase), −30° for sweep 0.
/// Source: Bitcraze's second-generation model, ibidem.
std::optional<LineProjection> project_sweep(const Lighthouse2& model, const Eigen::Vector3d& p_station);

/// With ogee and curve. X = x, Y = y, Z = −z; B = atan2(Z, X), y_d = tilt ± 30°, k = tan(y_d) Y / √(X² + Z²):
/// s = ogeemag sin(B − asin k + ogeephase) + curve, u = asin(Y / (|p| cos y_d)), m(u) a polynomial of fifth degree,
/// o = asin(k + m s / (cos y_d − m' s sin y_d)), raw = B − o + gibmag sin(B − o + gibphase) − phase − 90°.
/// Source: libsurvive's second-generation reprojection, ibidem.
std::optional<LineProjection> project_sweep(const Lighthouse2Full& model, const Eigen::Vector3d& p_station);

}  // namespace alidade
