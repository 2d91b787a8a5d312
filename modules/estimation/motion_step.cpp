// SPDX-License-Identifier: Apache-2.0
#include "estimation/motion_step.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace alidade {
namespace {

std::vector<double> normalised(std::vector<double> weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::vector<double> prior_weights(const MotionProcess& motion) {
  std::vector<double> weights;
  for (const MotionMode& mode : motion) weights.push_back(weights.empty() ? mode.weight : kCaution * mode.weight);
  return normalised(std::move(weights));
}

// The probability of each mode, from the log evidence that `evidence` gives for the noise of a mode, and with it the
// noise of the prediction.
template <class Evidence>
void weigh_modes(MotionStep& step, const MotionState& state, const MotionProcess& motion, const Evidence& evidence) {
  const std::vector<double> prior = prior_weights(motion);
  std::vector<Matrix18d> Q;  // of each mode
  std::vector<double> log_weight;
  for (std::size_t m = 0; m < motion.size(); ++m) {
    Q.push_back(noise_covariance(state, step.predicted, motion[m].noise));
    log_weight.push_back(std::log(prior[m]) + evidence(Q.back()));
  }
  const double greatest = *std::max_element(log_weight.begin(), log_weight.end());
  for (double w : log_weight) step.mode_weight.push_back(std::exp(w - greatest));
  step.log_evidence = greatest + std::log(std::accumulate(step.mode_weight.begin(), step.mode_weight.end(), 0.0));
  step.mode_weight = normalised(std::move(step.mode_weight));
  for (std::size_t m = 0; m < motion.size(); ++m) step.predicted.covariance += step.mode_weight[m] * Q[m];
}

}  // namespace

MotionState predict(const MotionState& state, Timestamp time, const MotionProcess& motion) {
  return predict(state, time, mean_noise(motion, prior_weights(motion)));
}

MotionStep absorb(const MotionState& state, Timestamp time, const MotionProcess& motion,
                  const PoseLikelihood& sightings) {
  MotionStep step;
  step.predicted = predict_without_noise(state, time);
  const PoseLikelihood likelihood = about(step.predicted.T_world_body, sightings);
  const Matrix6d P = covariance_in_map(step.predicted);
  weigh_modes(step, state, motion,
              [&](const Matrix18d& Q) { return log_evidence(P + Q.topLeftCorner<6, 6>(), likelihood); });
  step.state = absorb(step.predicted, likelihood);
  return step;
}

MotionStep absorb(const MotionState& state, Timestamp time, const MotionProcess& motion,
                  const MotionLikelihood& measurements) {
  MotionStep step;
  step.predicted = predict_without_noise(state, time);
  const MotionLikelihood likelihood = about(step.predicted, measurements);
  const Matrix18d P = step.predicted.covariance;
  weigh_modes(step, state, motion, [&](const Matrix18d& Q) { return log_evidence(P + Q, likelihood); });
  step.state = absorb(step.predicted, likelihood);
  return step;
}

MotionStep pass(const MotionState& state, Timestamp time, const MotionProcess& motion) {
  MotionStep step;
  step.predicted = step.state = predict(state, time, motion);
  step.mode_weight = prior_weights(motion);
  return step;
}

}  // namespace alidade
