// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "evaluation/association.h"

namespace alidade {

/// Whether the errors are as large as the covariances say: the normalised estimation error squared (NEES).
struct Consistency {
  std::vector<std::optional<double>> nees;  ///< per pose ξᵀ P⁻¹ ξ, 6 degrees of freedom; empty without a covariance
  std::size_t count = 0;                    ///< poses that have one
  double mean_per_degree = 0;               ///< mean NEES / 6: 1 for an honest filter, above it for a boastful one
  /// The 95 % bounds of mean_per_degree were the poses' errors independent; errors of neighbouring frames are not, so
  /// that an honest filter may leave them a little.
  double lower = 0, upper = 0;
};

/// ξ moves the estimate to its truth, in the estimate's axes, as its covariance does (StampedPose::covariance). Poses
/// without covariance, or with a singular one (a pose held fixed), are left out. Empty where none remains.
/// Throws std::invalid_argument for unequal lengths.
/// Source: Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and Navigation, section 5.4.
std::optional<Consistency> consistency(const PairedTrajectories& pairs);

}  // namespace alidade
