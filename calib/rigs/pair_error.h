// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "calib/rigs/rig_calibration.h"

namespace alidade {

/// How well two cameras of a fit agree on the corners with weight that both saw. Empty where there are none, or the
/// cameras stand at the same place.
std::optional<PairError> pair_error(const BundleFit& fit, const BundleFreedom& freedom,
                                    const BundleCovariance& covariance, int first, int second);

}  // namespace alidade
