// SPDX-License-Identifier: Apache-2.0
#include "marker1d/body_update.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace alidade {
namespace {

using Eigen::ArrayXd;

ArrayXd within(const ArrayXd& chi2, double bound) {
  return (chi2 <= bound).cast<double>();
}

// The state of greatest posterior density, as an error of the prediction: moved_by(prior, error).
class MapProblem {
 public:
  MapProblem(BodyReadings& readings, const MotionState& prior, const BodyUpdateOptions& options)
      : readings_(readings), prior_(prior), options_(options), root_(covariance_root(prior.covariance)) {
    linearise();
  }

  // Which readings the prediction allows for.
  ArrayXd gate() const {
    const ArrayXd innovation_variance = 1.0 + readings_.predicted_variance(prior_.covariance);
    return within(readings_.chi2() / innovation_variance, options_.gate_chi2);
  }

  // Graduated non-convexity: the weight narrows from what the prediction leaves open down to the gate.
  void descend(const ArrayXd& active) {
    constexpr double kFactor = 8.0, kWidest = 1e24;
    double mu = 1.0;
    while (mu < kWidest && is_too_narrow(active, mu / kFactor)) mu *= kFactor;
    for (; mu >= 1.0; mu /= kFactor) descend(active, mu);
  }

  // By what fits so far; each step decides anew what fits. Returns what fits in the end.
  ArrayXd settle() {
    ArrayXd fits = within(readings_.chi2(), options_.gate_chi2);
    for (int step = 0; step < options_.max_iterations && move(fits) > kFine; ++step) {
      fits = within(readings_.chi2(), options_.gate_chi2);
    }
    return within(readings_.chi2(), options_.gate_chi2);
  }

  MotionLikelihood likelihood(const ArrayXd& fits) const { return readings_.weighted_sum(fits); }

  // Goes on from another state.
  void move_to(const MotionState& state) {
    whitened_ = root_.triangularView<Eigen::Lower>().solve(error_between(prior_, state));
    linearise();
  }

  // Of all readings given the prior, at the optimum; outliers count as if they lay at the gate.
  double log_evidence(const ArrayXd& fits) const {
    const Matrix18d J = reset_jacobian(root_ * whitened_) * root_;
    const Matrix18d A = Matrix18d::Identity() + J.transpose() * likelihood(fits).information * J;
    const double cost = readings_.chi2().min(options_.gate_chi2).sum() + whitened_.squaredNorm();
    return -0.5 * cost - A.llt().matrixL().toDenseMatrix().diagonal().array().log().sum();
  }

 private:
  // In standard deviations: what a step leaves undone is quadratic in it.
  static constexpr double kRough = 3.0, kFine = 0.05;

  void linearise() { readings_.linearise(moved_by(prior_, root_ * whitened_)); }

  bool is_too_narrow(const ArrayXd& active, double mu) const {
    const double reached = (within(readings_.chi2(), mu * options_.gate_chi2) * active).sum();
    return reached <= std::floor(active.sum() / 3.0);
  }

  void descend(const ArrayXd& active, double mu) {
    const double per_width = 1.0 / (mu * options_.gate_chi2);
    for (int step = 0; step < std::max(1, options_.max_iterations / 3); ++step) {
      const ArrayXd weight = active / (1.0 + per_width * readings_.chi2()).square();
      if (move(weight) < kRough) break;
    }
  }

  // One Gauss–Newton step in the coordinates in which the prior is N(0, I); returns its length in standard deviations.
  double move(const ArrayXd& weight) {
    const MotionLikelihood z = readings_.weighted_sum(weight);
    const Matrix18d J = reset_jacobian(root_ * whitened_) * root_;
    const Matrix18d A = Matrix18d::Identity() + J.transpose() * z.information * J;
    const Vector18d step = A.llt().solve(J.transpose() * z.gradient - whitened_);
    if (!step.allFinite()) return 0.0;
    whitened_ += step;
    linearise();
    return std::sqrt(step.dot(A * step));
  }

  BodyReadings& readings_;
  const MotionState& prior_;
  const BodyUpdateOptions& options_;
  Matrix18d root_;
  Vector18d whitened_ = Vector18d::Zero();
};

// As wide as any mode of the motion allows.
MotionState widest_prediction(const MotionState& state, Timestamp time, const MotionProcess& motion) {
  MotionState predicted = predict_without_noise(state, time);
  Matrix18d Q = Matrix18d::Zero();
  for (const MotionMode& mode : motion) Q += noise_covariance(state, predicted, mode.noise);
  predicted.covariance += Q;
  return predicted;
}

}  // namespace

BodyUpdate update_body(BodyReadings readings, const MotionState& state, Timestamp time, const MotionProcess& motion,
                       const BodyUpdateOptions& options) {
  const MotionState widest = widest_prediction(state, time, motion);
  MapProblem wide(readings, widest, options);
  wide.descend(wide.gate());
  BodyUpdate update;
  update.motion = absorb(state, time, motion, wide.likelihood(wide.settle()));

  // Once more under the prior of those modes of the motion that the readings speak for.
  MapProblem problem(readings, update.motion.predicted, options);
  problem.move_to(update.motion.state);
  const ArrayXd fits = problem.settle();
  update.readings = problem.likelihood(fits);
  update.motion.state = absorb(update.motion.predicted, update.readings);
  update.chi2 = (fits > 0).select(readings.chi2(), 0.0).sum();
  update.inlier_count = static_cast<int>(fits.sum());
  update.degrees_of_freedom =
      fits.sum() - update.readings.information.cwiseProduct(update.motion.state.covariance).sum();
  for (double fit : fits) update.is_inlier.push_back(fit > 0);
  update.log_evidence = problem.log_evidence(fits);
  return update;
}

}  // namespace alidade
