// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reconstruction/bundle_adjustment.h"

namespace alidade {

/// Fills in the covariances of the free keyframes and of the points that they see, at the given (adjusted) map: the
/// inverse of the Gauss–Newton matrix by its Schur complement, in the gauge of the fixed keyframes. With fewer than two
/// of them the scale is held as well, by the distance from the first to the farthest keyframe. Points seen less than
/// twice keep theirs. Source: Triggs et al. 1999, section 9.
PointMap with_covariances(const Camera& camera, PointMap map, const BundleOptions& options);

}  // namespace alidade
