// SPDX-License-Identifier: Apache-2.0
#include "tracking/motion_step.h"

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

}  // namespace

CameraState predict(const CameraState& state, Timestamp time, const MotionProcess& motion) {
  return predict(state, time, mean_noise(motion, prior_weights(motion)));
}

MotionStep absorb(const CameraState& state, Timestamp time, const MotionProcess& motion,
                  const PoseLikelihood& sightings) {
  MotionStep step;
  step.predicted = predict_without_noise(state, time);
  const PoseLikelihood likelihood = about(step.predicted.T_world_camera, sightings);
  const Matrix6d P = covariance_in_map(step.predicted);
  const std::vector<double> prior = prior_weights(motion);
  std::vector<Matrix18d> Q;  // of each mode
  std::vector<double> log_weight;
  for (std::size_t m = 0; m < motion.size(); ++m) {
    Q.push_back(noise_covariance(state, step.predicted, motion[m].noise));
    log_weight.push_back(std::log(prior[m]) + log_evidence(P + Q.back().topLeftCorner<6, 6>(), likelihood));
  }
  const double greatest = *std::max_element(log_weight.begin(), log_weight.end());
  for (double w : log_weight) step.mode_weight.push_back(std::exp(w - greatest));
  step.log_evidence = greatest + std::log(std::accumulate(step.mode_weight.begin(), step.mode_weight.end(), 0.0));
  step.mode_weight = normalised(std::move(step.mode_weight));
  for (std::size_t m = 0; m < motion.size(); ++m) step.predicted.covariance += step.mode_weight[m] * Q[m];
  step.state = absorb(step.predicted, likelihood);
  return step;
}

MotionStep pass(const CameraState& state, Timestamp time, const MotionProcess& motion) {
  MotionStep step;
  step.predicted = step.state = predict(state, time, motion);
  step.mode_weight = prior_weights(motion);
  return step;
}

}  // namespace alidade
