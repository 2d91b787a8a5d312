// SPDX-License-Identifier: Apache-2.0
#include "estimation/pose_update.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "estimation/exact_sightings.h"
#include "estimation/pointwise_sightings.h"
#include "geometry/rotation.h"

namespace alidade {
namespace {

using Eigen::ArrayXd;

// 1 where χ² is within the bound, otherwise 0.
ArrayXd within(const ArrayXd& chi2, double bound) {
  ArrayXd is_within(chi2.size());
  std::transform(chi2.begin(), chi2.end(), is_within.begin(), [bound](double c) { return c <= bound ? 1.0 : 0.0; });
  return is_within;
}

// Sightings: ExactSightings or PointwiseSightings.
template <class Sightings>
class PoseProblem {
 public:
  PoseProblem(Sightings sightings, const PosePrior& prior, std::span<const PointObservation> observations,
              const PoseUpdateOptions& options)
      : sightings_(std::move(sightings)), prior_(prior), observations_(observations), options_(options) {}

  // Which observations may belong to the prior's pose (1, the others 0): the χ² gate with the innovation covariance
  // J P Jᵀ + R.
  ArrayXd gate_about_prior() {
    linearise(prior_.T_world_camera);
    const double wide = std::max(options_.gate_chi2, 16.0);  // the robust phase decides; the gate only trims
    const ArrayXd& chi2 = sightings_.chi2();
    ArrayXd passes = within(chi2, wide);  // then within J P Jᵀ + R all the more
    const Matrix6d P = prior_covariance();
    for (Eigen::Index i = 0; i < chi2.size(); ++i) {
      if (passes(i) > 0 || !std::isfinite(chi2(i))) continue;
      const double reach_px = options_.loosest_gate_px + 4.0 * observations_[static_cast<std::size_t>(i)].sigma_px;
      const Eigen::Matrix<double, 2, 7> rows = sightings_.in_px(i);
      const Eigen::Vector2d residual = rows.col(6);
      if (residual.norm() > reach_px) continue;
      const Eigen::Matrix2d S = rows.leftCols<6>() * P * rows.leftCols<6>().transpose() + sightings_.noise(i);
      if (residual.dot(S.inverse() * residual) <= wide) passes(i) = 1.0;
    }
    return passes;
  }

  // Whether a weight as wide as `mu` gates would leave out the better part of what passed the gate at the prior's pose.
  bool is_too_narrow(const ArrayXd& passes, double mu) const {
    const double reached = (within(sightings_.chi2(), mu * options_.gate_chi2) * passes).sum();
    return reached <= std::floor(passes.sum() / 3.0);
  }

  // Gauss–Newton with robust weights on the active observations and the prior. `mu` is the scale of the Geman–McClure
  // weight in units of the gate.
  Eigen::Isometry3d descend(Eigen::Isometry3d T, const ArrayXd& active, double mu) {
    const double per_width = 1.0 / (mu * options_.gate_chi2);
    for (int step = 0; step < std::max(1, options_.max_iterations / 3); ++step) {
      linearise(T);
      const ArrayXd weight = active / (1.0 + per_width * sightings_.chi2()).square();
      const Step next = solve(T, sightings_.weighted_sum(weight));
      if (!next.xi.allFinite()) break;
      T = moved(T, next.xi);
      if (next.sigmas < kRough) break;
    }
    return T;
  }

  // The same without weights, by what fits at the pose so far; each step decides anew what fits. `sightings` is what
  // the last step rests on. Empty where too few fit or the pose is not determined.
  std::optional<PoseUpdate> settle(Eigen::Isometry3d T) {
    for (int round = 0;; ++round) {
      linearise(T);
      const ArrayXd fits = within(sightings_.chi2(), options_.gate_chi2);
      if (fits.sum() < options_.least_inliers) return std::nullopt;
      const NormalEquations equations = sightings_.weighted_sum(fits);
      const Step next = solve(T, equations);
      if (!next.xi.allFinite() || !next.factor.isPositive() || next.factor.rcond() < 1e-16) return std::nullopt;
      if (round == options_.max_iterations || next.sigmas <= kFine) return outcome(T, fits, equations, next);
      T = moved(T, next.xi);
    }
  }

 private:
  // What a step leaves undone is quadratic in it, and small: a step of one standard deviation leaves a hundredth. The
  // robust phase only has to come near enough for settle() to go on.
  static constexpr double kRough = 3.0, kFine = 0.1;

  struct Step {
    Vector6d xi;
    double sigmas;  // length of the step in standard deviations
    Eigen::LDLT<Matrix6d> factor;
  };

  // Keeps what is linearised about this pose already.
  void linearise(const Eigen::Isometry3d& T_world_camera) {
    if (at_ && at_->matrix() == T_world_camera.matrix() && sightings_.is_settled()) return;
    sightings_.linearise(T_world_camera.inverse());
    at_ = T_world_camera;
  }

  Step solve(const Eigen::Isometry3d& T, const NormalEquations& sightings) const {
    const Vector6d from_prior = difference(prior_.T_world_camera, T);
    const Matrix6d J_prior = prior_jacobian(T, from_prior);
    const Matrix6d JtI = J_prior.transpose() * prior_.information;
    const Matrix6d A = sightings.information + JtI * J_prior;
    Step step{Vector6d::Zero(), 0.0, Eigen::LDLT<Matrix6d>(A)};
    step.xi = step.factor.solve(sightings.gradient - JtI * from_prior);
    step.sigmas = std::sqrt(std::max(0.0, step.xi.dot(A * step.xi)));
    return step;
  }

  PoseUpdate outcome(const Eigen::Isometry3d& T, const ArrayXd& fits, const NormalEquations& equations,
                     const Step& last) const {
    PoseUpdate result;
    result.T_world_camera = moved(T, last.xi);
    result.covariance = last.factor.solve(Matrix6d::Identity());
    result.sightings = {T, equations.information, equations.gradient};
    result.is_inlier.resize(observations_.size());
    for (std::size_t i = 0; i < observations_.size(); ++i) result.is_inlier[i] = fits(static_cast<Eigen::Index>(i)) > 0;
    result.inlier_count = static_cast<int>(fits.sum());
    // χ² at the pose after the step, to second order.
    const double chi2 = equations.chi2 - last.xi.dot(2.0 * equations.gradient - equations.information * last.xi);
    if (result.inlier_count > 3) result.chi2_per_dof = chi2 / (2.0 * result.inlier_count - 6.0);
    return result;
  }

  static Eigen::Isometry3d moved(const Eigen::Isometry3d& T, const Vector6d& xi) {
    Eigen::Isometry3d next = T * perturbation(xi);
    next.linear() = exp_so3(log_so3(next.linear()));
    return next;
  }

  // How the difference from the prior moves with xi: the pose's axes have turned away from the prior's.
  Matrix6d prior_jacobian(const Eigen::Isometry3d& T, const Vector6d& from_prior) const {
    Matrix6d J = Matrix6d::Zero();
    J.topLeftCorner<3, 3>() = prior_.T_world_camera.linear().transpose() * T.linear();
    J.bottomRightCorner<3, 3>() = right_jacobian_so3(from_prior.tail<3>()).inverse();
    return J;
  }

  Matrix6d prior_covariance() const {
    // A prior that knows nothing gates nothing: a tiny information keeps the inverse finite.
    const Matrix6d I = prior_.information + 1e-9 * Matrix6d::Identity();
    return I.inverse();
  }

  Sightings sightings_;
  const PosePrior& prior_;
  std::span<const PointObservation> observations_;
  const PoseUpdateOptions& options_;
  std::optional<Eigen::Isometry3d> at_;  // where the sightings are linearised
};

template <class Sightings>
std::optional<PoseUpdate> solve(PoseProblem<Sightings> problem, const PosePrior& prior, int least_inliers) {
  const ArrayXd gated = problem.gate_about_prior();
  if (gated.sum() < least_inliers) return std::nullopt;
  // Graduated non-convexity: the weight function narrows from far beyond the gate down to it.
  Eigen::Isometry3d T = prior.T_world_camera;
  constexpr double kFactor = 8.0, kWidest = 1e24;
  double mu = 1.0;
  while (mu < kWidest && problem.is_too_narrow(gated, mu / kFactor)) mu *= kFactor;
  for (; mu > 1.0; mu /= kFactor) T = problem.descend(T, gated, mu);
  return problem.settle(problem.descend(T, gated, 1.0));
}

}  // namespace

std::optional<PoseUpdate> update_pose(const Camera& camera, const PosePrior& prior,
                                      std::span<const PointObservation> observations,
                                      const PoseUpdateOptions& options) {
  const bool is_exact =
      is_pinhole(camera.distortion) && (options.map_uncertainty == MapUncertainty::Ignored ||
                                        std::all_of(observations.begin(), observations.end(), has_exact_point));
  if (is_exact) {
    ExactSightings sightings(camera, observations, options.variance_factor);
    return solve(PoseProblem(std::move(sightings), prior, observations, options), prior, options.least_inliers);
  }
  PointwiseSightings sightings(camera, observations, options.variance_factor, options.map_uncertainty);
  return solve(PoseProblem(std::move(sightings), prior, observations, options), prior, options.least_inliers);
}

std::optional<Eigen::Matrix2d> measurement_noise(const Camera& camera, const Eigen::Isometry3d& T_world_camera,
                                                 const PointObservation& observation, MapUncertainty map_uncertainty) {
  PointwiseSightings sighting(camera, {&observation, 1}, 1.0, map_uncertainty);
  sighting.linearise(T_world_camera.inverse());
  if (!std::isfinite(sighting.chi2()(0))) return std::nullopt;
  return sighting.noise(0);
}

}  // namespace alidade
