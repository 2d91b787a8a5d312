// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "estimation/motion_step.h"
#include "marker1d/body_readings.h"

namespace alidade {

struct BodyUpdateOptions {
  double gate_chi2 = 20.0;  ///< a reading beyond it (1 degree of freedom; 1 of 130,000 right ones) is an outlier
  int max_iterations = 12;  ///< Gauss–Newton steps of each phase; 3 are usual
};

/// What a batch of readings did to the belief about a body.
struct BodyUpdate {
  MotionStep motion;
  std::vector<bool> is_inlier;  ///< one per reading
  int inlier_count = 0;
  MotionLikelihood readings;        ///< of the inliers alone
  double chi2 = 0.0;                ///< of the inliers' whitened residuals at the state
  double degrees_of_freedom = 0.0;  ///< of this χ²: what it is in the mean, where their sigma is right
  double log_evidence = 0.0;        ///< of the batch given the prediction, outliers counted at the gate
};

/// The state at `time` after readings about that time: one iterated robust maximum a posteriori update of the whole
/// batch, with the predicted covariance as prior. Readings inside the gate about the prediction pass a redescending
/// weight (Geman–McClure, graduated); those that fit the state found so give state and covariance.
/// Source: marker1d paper page, "where we go past it", 1 and 2.
BodyUpdate update_body(const BodyReadings& readings, const MotionState& state, Timestamp time,
                       const MotionProcess& motion, const BodyUpdateOptions& options = {});

/// The same, searched from other starts as well where the prediction leaves so much open that the readings bend away
/// from their linearisation: near configurations in which two poses explain them. `others` are poses to start from.
/// Different optima only, the most probable first.
std::vector<BodyUpdate> update_body_everywhere(const BodyReadings& readings, const MotionState& state, Timestamp time,
                                               const MotionProcess& motion, const BodyUpdateOptions& options,
                                               std::span<const Eigen::Isometry3d> others = {});

/// Whether the state is so sure that readings are linear in what is left.
bool is_nearly_linear(const MotionState& state);

/// Whether two beliefs cannot be told apart: their poses differ by less than three standard deviations of either.
bool is_same(const MotionState& a, const MotionState& b);

}  // namespace alidade
