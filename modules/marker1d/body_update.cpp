// SPDX-License-Identifier: Apache-2.0
#include "marker1d/body_update.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "geometry/rotation.h"

namespace alidade {
namespace {

using Eigen::ArrayXd;

constexpr double kNearlyLinear = 0.01;  // rad: half its square times a body of 0.3 m is a usual reading's noise

ArrayXd within(const ArrayXd& chi2, double bound) {
  return (chi2 <= bound).cast<double>();
}

// The state of greatest posterior density, as an error of the prediction: moved_by(prior, error).
class MapProblem {
 public:
  MapProblem(BodyReadings& readings, const MotionState& prior, const BodyUpdateOptions& options)
      : readings_(readings),
        prior_(prior),
        options_(options),
        root_(root_of(prior, readings.is_of_pose_at(prior.time))) {
    whitened_.setZero(root_.cols());
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
    const auto k = root_.cols();
    whitened_ = root_.topRows(k).triangularView<Eigen::Lower>().solve(error_between(prior_, state).head(k));
    linearise();
  }

  // Of all readings given the prior, at the optimum; outliers count as if they lay at the gate.
  double log_evidence(const ArrayXd& fits) const {
    const Square A = posterior_information(jacobian(), likelihood(fits));
    const double cost = readings_.chi2().min(options_.gate_chi2).sum() + whitened_.squaredNorm();
    return -0.5 * cost - A.llt().matrixLLT().diagonal().array().log().sum();
  }

 private:
  // Errors of the state, a column per whitened coordinate: 18, or 6 where the readings are of the pose alone, so that
  // all else follows it by its correlation.
  using Columns = Eigen::Matrix<double, 18, Eigen::Dynamic, 0, 18, 18>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 18, 18>;
  using Whitened = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 18, 1>;

  static Columns root_of(const MotionState& prior, bool is_of_pose) {
    if (!is_of_pose) return covariance_root(prior.covariance);
    const Eigen::LLT<Matrix6d> L(prior.covariance.topLeftCorner<6, 6>());
    if (L.info() != Eigen::Success) return covariance_root(prior.covariance);
    return L.matrixL().solve(prior.covariance.topRows<6>()).transpose();
  }

  Columns jacobian() const {
    const Vector18d error = root_ * whitened_;
    Columns J = root_;
    J.topRows<3>() = exp_so3(-error.segment<3>(3)) * root_.topRows<3>();
    J.middleRows<3>(3) = right_jacobian_so3(error.segment<3>(3)) * root_.middleRows<3>(3);
    return J;
  }

  static Square posterior_information(const Columns& J, const MotionLikelihood& z) {
    const auto k = J.cols();
    Square A = Square::Identity(k, k);
    if (k == 6) {
      const Matrix6d J_pose = J.topRows<6>();
      A += J_pose.transpose() * z.information.topLeftCorner<6, 6>() * J_pose;
    } else {
      A += J.transpose() * z.information * J;
    }
    return A;
  }

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
    const Columns J = jacobian();
    const Square A = posterior_information(J, z);
    const Whitened step = A.llt().solve(J.transpose() * z.gradient - whitened_);
    if (!step.allFinite()) return 0.0;
    whitened_ += step;
    linearise();
    return std::sqrt(step.dot(A * step));
  }

  BodyReadings& readings_;
  const MotionState& prior_;
  const BodyUpdateOptions& options_;
  Columns root_;
  Whitened whitened_;
};

// As wide as any mode of the motion allows.
MotionState widest_prediction(const MotionState& state, Timestamp time, const MotionProcess& motion) {
  MotionState predicted = predict_without_noise(state, time);
  Matrix18d Q = Matrix18d::Zero();
  for (const MotionMode& mode : motion) Q += noise_covariance(state, predicted, mode.noise);
  predicted.covariance += Q;
  return predicted;
}

// Columns: one standard deviation along the directions of the pose that are known less than readings are linear for
// (turns counted in rad, places in units of 0.3 m), with all that is correlated; the least known first. Never none.
Eigen::Matrix<double, 18, Eigen::Dynamic> open_directions(const MotionState& state) {
  Vector6d per_unit;
  per_unit << Eigen::Vector3d::Constant(1 / 0.3), Eigen::Vector3d::Ones();
  const Matrix6d P = per_unit.asDiagonal() * state.covariance.topLeftCorner<6, 6>() * per_unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> axes(P);
  const auto count = std::max<Eigen::Index>(1, (axes.eigenvalues().array() > kNearlyLinear * kNearlyLinear).count());
  Eigen::Matrix<double, 18, Eigen::Dynamic> directions(18, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Vector6d along = per_unit.asDiagonal() * axes.eigenvectors().col(5 - k);
    directions.col(k) = state.covariance.leftCols<6>() * along / std::sqrt(std::max(1e-300, axes.eigenvalues()(5 - k)));
  }
  return directions;
}

// Readings that leave a direction open say less of it than their derivatives at one point pretend: where the state may
// go, they bend. Takes that as noise, for as wide as the state then is.
void widen_by_curvature(BodyReadings readings, const ArrayXd& fits, BodyUpdate& update) {
  constexpr int kRounds = 3;
  readings.linearise(update.readings.at);
  const Eigen::VectorXd residuals = readings.residuals();
  for (int round = 0; round < kRounds; ++round) {
    const auto directions = open_directions(update.motion.state);
    BodyReadings beside = readings;
    Eigen::MatrixXd bends = (-2.0 * residuals).replicate(1, directions.cols());
    for (Eigen::Index k = 0; k < directions.cols(); ++k) {
      for (double side : {-1.0, 1.0}) {
        beside.linearise(moved_by(update.readings.at, side * directions.col(k)));
        bends.col(k) += beside.residuals();
      }
    }
    update.readings = readings.weighted_sum(fits, bends);
    update.motion.state = absorb(update.motion.predicted, update.readings);
  }
}

// From `start` where it is given, else from the prediction.
BodyUpdate update_from(const MotionState* start, BodyReadings readings, const MotionState& state, Timestamp time,
                       const MotionProcess& motion, const BodyUpdateOptions& options) {
  const MotionState widest = widest_prediction(state, time, motion);
  MapProblem wide(readings, widest, options);
  const ArrayXd gated = wide.gate();
  if (start) wide.move_to(*start);
  wide.descend(gated);
  BodyUpdate update;
  update.motion = absorb(state, time, motion, wide.likelihood(wide.settle()));

  // Once more under the prior of those modes of the motion that the readings speak for.
  MapProblem problem(readings, update.motion.predicted, options);
  problem.move_to(update.motion.state);
  const ArrayXd fits = problem.settle();
  update.readings = problem.likelihood(fits);
  update.motion.state = absorb(update.motion.predicted, update.readings);
  if (!is_nearly_linear(update.motion.state)) widen_by_curvature(readings, fits, update);
  update.chi2 = (fits > 0).select(readings.chi2(), 0.0).sum();
  update.inlier_count = static_cast<int>(fits.sum());
  update.degrees_of_freedom =
      fits.sum() - update.readings.information.cwiseProduct(update.motion.state.covariance).sum();
  for (double fit : fits) update.is_inlier.push_back(fit > 0);
  update.log_evidence = problem.log_evidence(fits);
  return update;
}

// The prediction moved to a pose, with all that is correlated with it.
MotionState moved_to(const MotionState& predicted, const Eigen::Isometry3d& T_world_body) {
  const Matrix6d P = predicted.covariance.topLeftCorner<6, 6>();
  const Vector6d off = difference(predicted.T_world_body, T_world_body);
  return moved_by(predicted, predicted.covariance.leftCols<6>() * P.ldlt().solve(off));
}

}  // namespace

// Whether the state is so sure of the pose that the readings are linear in what is left.
bool is_nearly_linear(const MotionState& state) {
  return state.covariance.diagonal().segment<3>(3).maxCoeff() < kNearlyLinear * kNearlyLinear;
}

bool is_same(const MotionState& a, const MotionState& b) {
  const Vector6d off = difference(a.T_world_body, b.T_world_body);
  const auto is_near = [&off](const MotionState& state) {
    return off.dot(state.covariance.topLeftCorner<6, 6>().ldlt().solve(off)) < 9.0;
  };
  return is_near(a) && is_near(b);
}

BodyUpdate update_body(const BodyReadings& readings, const MotionState& state, Timestamp time,
                       const MotionProcess& motion, const BodyUpdateOptions& options) {
  return update_from(nullptr, readings, state, time, motion, options);
}

std::vector<BodyUpdate> update_body_everywhere(const BodyReadings& readings, const MotionState& state, Timestamp time,
                                               const MotionProcess& motion, const BodyUpdateOptions& options,
                                               std::span<const Eigen::Isometry3d> others) {
  std::vector<BodyUpdate> updates{update_body(readings, state, time, motion, options)};
  const MotionState predicted = widest_prediction(state, time, motion);
  std::vector<MotionState> starts;
  if (!is_nearly_linear(predicted)) {
    const Vector18d sigma = open_directions(predicted).col(0);
    for (double sigmas : {-2.0, 2.0}) starts.push_back(moved_by(predicted, sigmas * sigma));
  }
  for (const Eigen::Isometry3d& T_world_body : others) starts.push_back(moved_to(predicted, T_world_body));
  for (const MotionState& start : starts) {
    BodyUpdate update = update_from(&start, readings, state, time, motion, options);
    const bool is_new = std::none_of(updates.begin(), updates.end(), [&](const BodyUpdate& known) {
      return is_same(known.motion.state, update.motion.state);
    });
    if (is_new) updates.push_back(std::move(update));
  }
  std::stable_sort(updates.begin(), updates.end(),
                   [](const BodyUpdate& a, const BodyUpdate& b) { return a.log_evidence > b.log_evidence; });
  return updates;
}

}  // namespace alidade
