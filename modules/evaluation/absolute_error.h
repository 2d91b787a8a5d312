// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "evaluation/association.h"
#include "evaluation/statistics.h"

namespace alidade {

/// How far each pose of the estimate is from its truth (APE).
struct AbsoluteErrors {
  ErrorSeries translation_m;  ///< distance of the centres
  ErrorSeries rotation_deg;   ///< angle of R_truthᵀ R_estimate
};

/// The errors of the pairs as they stand: align the estimate first. Throws std::invalid_argument for unequal lengths.
AbsoluteErrors absolute_errors(const PairedTrajectories& pairs);

}  // namespace alidade
